#pragma once

#include "softform/optimizers/optimizer.hpp"

namespace softform {

struct AugmentedLagrangianOptions {
  /// First penalty mu and its factor where the constraints do not fall fast enough.
  double penalty = 1;
  double penalty_increase = 10;
  double largest_penalty = 1e8;
  /// The constraints' largest entry has to fall by this factor for the multipliers to be updated.
  double sufficient_decrease = 0.25;
  /// Largest entry of the constraints at a solution.
  double feasibility = 1e-8;
  /// First Levenberg-Marquardt damping of the inner minimisation and its factors after a good and a bad step.
  double damping = 1e-3;
  double damping_decrease = 0.2;
  double damping_increase = 4;
  double largest_damping = 1e10;
};

/// The augmented Lagrangian method (3.52, 3.53): minimises
///     L(z) = f(z) - lambda^t c(z) + mu/2 |c(z)|^2
/// for fixed multipliers, then updates them, lambda <- lambda - mu c, where c fell enough, or else raises mu. The inner
/// steps are Gauss-Newton steps (H + mu J^t J + alpha D) dz = -grad L, damped after Levenberg and Marquardt. Where the
/// programme can restore feasibility, the solution is restored at the end. Counts inner iterations.
class AugmentedLagrangian : public Optimizer {
 public:
  explicit AugmentedLagrangian(AugmentedLagrangianOptions options = {}) : options_(options) {}
  Solution minimize(const NonlinearProgram& program, const StopCriteria& stop = {},
                    const IterationObserver& observer = {}) const override;

 private:
  AugmentedLagrangianOptions options_;
};

}  // namespace softform
