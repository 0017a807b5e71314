#include "softform/optimizers/quadratic_penalty.hpp"

#include <algorithm>

#include "softform/optimizers/optimality.hpp"

namespace softform {

Solution QuadraticPenalty::minimize(const NonlinearProgram& program, const StopCriteria& stop,
                                    const IterationObserver& observer) const
{
  require(program, "quadratic_penalty", true, true);
  ProjectedNewton newton(program, options_.newton, stop, observer);
  double& penalty = newton.function().penalty;
  const double unit = newton.function().balanced_penalty(program.initial_point());
  penalty = options_.penalty * unit;
  if (!newton.start()) return std::move(newton).solution();

  double inner_tolerance = std::max(options_.inner_tolerance, stop.tolerance);
  while (newton.minimize(inner_tolerance) != ProjectedNewton::Outcome::Ended &&
         !newton.finish_feasible(inner_tolerance)) {
    const bool is_feasible = newton.point().infeasibility() <= stop.tolerance;
    if (!is_feasible && penalty >= options_.largest_penalty * unit) {
      newton.finish_infeasible();
      break;
    }
    if (!is_feasible) penalty *= options_.penalty_increase;
    inner_tolerance = std::max(stop.tolerance, options_.inner_tolerance_decrease * inner_tolerance);
  }
  return std::move(newton).solution();
}

}  // namespace softform
