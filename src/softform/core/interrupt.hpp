#pragma once

namespace softform {

/// From here on the first Ctrl-C only raises a flag, so that solvers end with what they have; a second one ends the
/// program at once.
void catch_interrupts();

/// True once Ctrl-C was pressed.
bool interrupted();

}  // namespace softform
