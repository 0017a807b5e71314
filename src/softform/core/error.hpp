#pragma once

#include <stdexcept>

namespace softform {

/// Input that cannot be used. The message names the file, the line or element, and the cure.
/// Thrown before any work; the command line turns it into exit code 2.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace softform
