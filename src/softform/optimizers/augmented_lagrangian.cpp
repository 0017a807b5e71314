#include "softform/optimizers/augmented_lagrangian.hpp"

#include <algorithm>
#include <cmath>

#include "softform/optimizers/optimality.hpp"

namespace softform {

Solution AugmentedLagrangian::minimize(const NonlinearProgram& program, const StopCriteria& stop,
                                       const IterationObserver& observer) const
{
  require(program, "augmented_lagrangian", true, true);
  ProjectedNewton newton(program, options_.newton, stop, observer);
  AugmentedFunction& function = newton.function();
  const double unit = function.balanced_penalty(program.initial_point());
  function.penalty = options_.penalty * unit;
  if (!newton.start()) return std::move(newton).solution();

  double allowed = HUGE_VAL, inner_tolerance = std::max(options_.inner_tolerance, stop.tolerance);
  while (newton.minimize(inner_tolerance) != ProjectedNewton::Outcome::Ended &&
         !newton.finish_feasible(inner_tolerance)) {
    const double infeasibility = newton.point().infeasibility();
    if (infeasibility <= std::max(allowed, stop.tolerance)) {
      function.multipliers = function.estimated_multipliers(newton.point());  // (3.53)
      allowed = options_.sufficient_decrease * infeasibility;
      inner_tolerance = std::max(stop.tolerance, options_.inner_tolerance_decrease * inner_tolerance);
    } else if (function.penalty < options_.largest_penalty * unit) {
      function.penalty *= options_.penalty_increase;
    } else {
      newton.finish_infeasible();
      break;
    }
  }
  return std::move(newton).solution();
}

}  // namespace softform
