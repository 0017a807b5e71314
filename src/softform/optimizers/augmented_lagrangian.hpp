#pragma once

#include "softform/optimizers/optimizer.hpp"
#include "softform/optimizers/projected_newton.hpp"

namespace softform {

struct AugmentedLagrangianOptions {
  /// First penalty mu, and its factor where the constraints do not fall fast enough; mu in units of
  /// AugmentedFunction::balanced_penalty. Small enough that the objective still guides the first minimisation: too
  /// large, and the steps creep along the curved constraints.
  double penalty = 10;
  double penalty_increase = 10;
  /// The cap, likewise: beyond, the Hessian of the penalty leaves no digits to that of the objective.
  double largest_penalty = 1e10;
  /// The constraints' largest entry has to fall by this factor from one update of the multipliers to the next.
  double sufficient_decrease = 0.25;
  /// First tolerance of the inner minimisations and its factor at each update, until it is that of the whole: accurate
  /// minimisers for inaccurate multipliers are not worth their price.
  double inner_tolerance = 1e-2;
  double inner_tolerance_decrease = 0.1;
  ProjectedNewtonOptions newton;
};

/// The augmented Lagrangian method (3.52, 3.53; Nocedal and Wright 2000, 17.4). It minimises
///     f(z) + lambda . c(z) + mu/2 |c(z)|^2   within the bounds
/// for fixed multipliers by ProjectedNewton, then either updates them, lambda <- lambda + mu c, where the constraints
/// fell enough, or raises mu. The thesis' lambda has the other sign. Iterations count inner steps.
class AugmentedLagrangian : public Optimizer {
 public:
  explicit AugmentedLagrangian(AugmentedLagrangianOptions options = {}) : options_(options) {}
  Solution minimize(const NonlinearProgram& program, const StopCriteria& stop = {},
                    const IterationObserver& observer = {}) const override;

 private:
  AugmentedLagrangianOptions options_;
};

}  // namespace softform
