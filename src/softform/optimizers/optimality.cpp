#include "softform/optimizers/optimality.hpp"

#include <cmath>
#include <string>

#include <fmt/format.h>

#include "softform/core/error.hpp"

namespace softform {

void require(const NonlinearProgram& program, const char* method, bool takes_constraints, bool takes_bounds)
{
  const int n = program.variable_count();
  const Vec z = program.initial_point(), lower = program.lower_bounds(), upper = program.upper_bounds();
  const auto refuse = [&](const std::string& reason) {
    throw InputError(fmt::format("{}: {} {}", program.name(), method, reason));
  };
  if (n < 1 || z.size() != n || lower.size() != n || upper.size() != n)
    refuse(fmt::format("needs a start and bounds of {} variables", n));
  if (!z.allFinite()) refuse("needs a start that is finite");
  for (int i = 0; i < n; ++i)
    if (!(lower[i] <= upper[i])) refuse(fmt::format("needs bounds in order; those of variable {} are not", i));
  if (!takes_constraints && program.constraint_count() > 0)
    refuse("takes no constraints: use sqp, augmented_lagrangian or ipopt");
  const bool has_bounds = (lower.array() > -HUGE_VAL).any() || (upper.array() < HUGE_VAL).any();
  if (!takes_bounds && has_bounds) refuse("takes no bounds: use gradient_projection, augmented_lagrangian or ipopt");
}

}  // namespace softform
