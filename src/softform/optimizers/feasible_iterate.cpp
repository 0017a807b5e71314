#include "softform/optimizers/feasible_iterate.hpp"

#include <cmath>

#include "softform/core/stopwatch.hpp"

namespace softform {

std::optional<Vec> FeasibleIterate::restore(const Vec& z)
{
  const Stopwatch watch(solution_.report.times.restoration);
  return program_.restore(z);
}

bool FeasibleIterate::start(const Vec& z)
{
  const auto feasible = restore(z);
  solution_.z = feasible.value_or(z);
  if (feasible) solution_.objective = program_.objective(solution_.z);
  return feasible.has_value();
}

bool FeasibleIterate::accepts(const Vec& d)
{
  const auto restored = restore(solution_.z + d);
  const double objective = restored ? program_.objective(*restored) : HUGE_VAL;
  if (!(objective < solution_.objective)) return false;
  decrease_ = solution_.objective - objective;
  step_norm_ = (*restored - solution_.z).norm();
  solution_.z = *restored;
  solution_.objective = objective;
  return true;
}

}  // namespace softform
