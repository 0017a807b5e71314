#pragma once

#include "softform/optimizers/nonlinear_program.hpp"

namespace softform {

/// Throws InputError when the programme has constraints or bounds that the method does not take, or sizes that do not
/// fit together, or a start that is not finite.
void require(const NonlinearProgram& program, const char* method, bool takes_constraints, bool takes_bounds);

}  // namespace softform
