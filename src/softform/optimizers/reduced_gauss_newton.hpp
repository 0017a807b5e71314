#pragma once

#include "softform/optimizers/optimizer.hpp"

namespace softform {

struct ReducedGaussNewtonOptions {
  /// Weight mu of the linearised constraints in the step: large enough that the state follows the design, small enough
  /// that round-off of mu J^t J, and the shift that covers it, stay below the curvature of the objective.
  double constraint_weight = 1e3;
  /// How often a step that fails is halved before the matrix is factorised again with a higher damping.
  int halvings = 2;
  /// First Levenberg-Marquardt damping, its factors after a good and a bad step, and when to give up.
  double damping = 0.1;
  double damping_decrease = 0.25;
  double damping_increase = 4;
  double largest_damping = 1e6;
};

/// Gauss-Newton on the feasible manifold, for programmes that can restore feasibility:
///   1. step dz from (H + mu J^t J + alpha D) dz = -(g + mu J^t c), H the Gauss-Newton Hessian and D the programme's
///      metric (a Sobolev metric on shapes decides how fast it is); with bounds, the minimum of that model within them
///      by an active set on its Schur complement, for programmes with few bounded variables;
///   2. restore: the state is solved for again at the new design, starting from the predicted one;
///   3. accept on the true objective alone, after halving the step if need be, and adapt alpha (Levenberg-Marquardt;
///      Nocedal and Wright 2000, 10.3).
/// It also ends when the model promises less than a share 1/patience of StopCriteria::relative_decrease.
/// Every iterate is feasible, so that the best so far can be used at any time.
class ReducedGaussNewton : public Optimizer {
 public:
  explicit ReducedGaussNewton(ReducedGaussNewtonOptions options = {}) : options_(options) {}
  Solution minimize(const NonlinearProgram& program, const StopCriteria& stop = {},
                    const IterationObserver& observer = {}) const override;

 private:
  ReducedGaussNewtonOptions options_;
};

}  // namespace softform
