#include "softform/optimizers/gradient_projection.hpp"

#include "softform/optimizers/optimality.hpp"

namespace softform {

Solution GradientProjection::minimize(const NonlinearProgram& program, const StopCriteria& stop,
                                      const IterationObserver& observer) const
{
  require(program, "gradient_projection", false, true);
  ProjectedNewton newton(program, options_, stop, observer);
  if (newton.start() && newton.minimize(stop.tolerance) != ProjectedNewton::Outcome::Ended)
    newton.finish_feasible(stop.tolerance);
  return std::move(newton).solution();
}

}  // namespace softform
