#pragma once

#include "softform/optimizers/optimizer.hpp"

namespace softform {

struct FeasibleNewtonOptions {
  /// Relative decrease of the objective in an iteration under which Gauss-Newton's Hessian is given up for the exact
  /// one: far from the optimum it is the better model, near it it crawls.
  double gauss_newton_decrease = 0.02;
  /// How often a step that fails is halved before the damping is raised.
  int halvings = 1;
  /// Levenberg-Marquardt damping in units of max|H| / max|D|, D the programme's metric: at first, its factors after a
  /// good and a bad step, and its limits. It never vanishes: designs may move in ways that nothing sees.
  double damping = 1e-3;
  double damping_decrease = 0.25;
  double damping_increase = 4;
  double smallest_damping = 1e-9;
  double largest_damping = 1e6;
  /// The damping of the Gauss-Newton system that measures the trust region of Newton's steps, and how far the region
  /// may shrink in an iteration.
  double metric_damping = 1e-3;
  double smallest_radius = 1e-8;
  /// Relative residual of the linear solves, and what is put into their zero block, see KktSystem.
  double linear_tolerance = 1e-8;
  double constraint_regularization = 1e-10;
};

/// Newton's method on the feasible manifold, for programmes that can restore feasibility (see
/// NonlinearProgram::restore):
///   1. (d, lambda) from the KKT system [H + alpha D, J^t; J, 0] (d, lambda) = -(g, c), H Gauss-Newton's Hessian;
///      alpha is raised until the inertia shows H + alpha D convex where J d = 0. When these steps gain little, d
///      minimises the model of the exact Hessian of the Lagrangian, convex or not, in a trust region whose metric is
///      that system (TrustRegionModel);
///   2. restore: the state is solved for again at the new design, starting from the predicted one;
///   3. accept on the true objective alone, and adapt alpha or the region.
/// Every iterate is feasible, so that there is no merit function to balance and the best so far can be used at any
/// time. Converges when |g + J^t lambda| falls under StopCriteria::tolerance, in absolute terms.
class FeasibleNewton : public Optimizer {
 public:
  explicit FeasibleNewton(FeasibleNewtonOptions options = {}) : options_(options) {}
  Solution minimize(const NonlinearProgram& program, const StopCriteria& stop = {},
                    const IterationObserver& observer = {}) const override;

 private:
  FeasibleNewtonOptions options_;
};

}  // namespace softform
