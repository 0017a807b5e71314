#pragma once

#include "softform/optimizers/optimizer.hpp"
#include "softform/optimizers/projected_newton.hpp"

namespace softform {

struct QuadraticPenaltyOptions {
  /// First penalty mu, its factor, and its cap, in units of AugmentedFunction::balanced_penalty: the constraints end at
  /// about lambda / mu, and the condition number of the Hessian grows with mu.
  double penalty = 10;
  double penalty_increase = 10;
  double largest_penalty = 1e10;
  /// First tolerance of the inner minimisations and its factor at each increase, until it is that of the whole.
  double inner_tolerance = 1e-2;
  double inner_tolerance_decrease = 0.1;
  ProjectedNewtonOptions newton;
};

/// The quadratic penalty method (3.40): minimises f(z) + mu/2 |c(z)|^2 within the bounds for growing mu, each time from
/// the last minimiser, by ProjectedNewton. The multipliers returned are mu c. Iterations count inner steps.
class QuadraticPenalty : public Optimizer {
 public:
  explicit QuadraticPenalty(QuadraticPenaltyOptions options = {}) : options_(options) {}
  Solution minimize(const NonlinearProgram& program, const StopCriteria& stop = {},
                    const IterationObserver& observer = {}) const override;

 private:
  QuadraticPenaltyOptions options_;
};

}  // namespace softform
