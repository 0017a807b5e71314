#pragma once

#include "softform/optimizers/optimizer.hpp"

namespace softform {

struct SqpOptions {
  /// Relative residual at which a linear solve is good enough. The globalisation copes with large ones (0.1 works on
  /// small problems), but Newton's quadratic end is lost.
  double linear_tolerance = 1e-10;
  /// Put into the zero block of what is factorised, in units of max|J|^2 / max|H|: equilibrium constraints always have
  /// dependent rows (forces and torques sum to zero).
  double constraint_regularization = 1e-8;

  /// theta of (3.50), in units of max|H|: how much curvature counts as convex.
  double curvature = 1e-8;
  /// The step counts as normal when its tangential part is at most this times the normal one, squared norms.
  double normal_ratio = 10;
  /// The Hessian is shifted by a multiple of the programme's step metric D: first in units of max|H| / max|D|, its
  /// growth, its decrease after a full step, and its limits.
  double first_shift = 1e-4;
  double shift_increase = 4;
  double shift_decrease = 0.25;
  double largest_shift = 1e10;
  double smallest_shift = 1e-9;  ///< below it there is none, for the sake of Newton's quadratic end
  /// A step that has to be shortened below this was too long for the model: the shift grows instead. Along the flat
  /// directions of a design, the line search alone would crawl.
  double shortest_step = 0.3;

  /// mu of (3.47) at the start, in units of the first multipliers: what the merit has to exceed to be exact. From there
  /// it only grows. Larger, it holds the steps to the constraints' curvature; smaller, it lets them leave the
  /// constraints.
  double first_penalty = 1;
  double tau = 0.1;                  ///< share of the linearised infeasibility's decrease that the merit has to make
  double linearized_decrease = 0.9;  ///< |J dy + c| / |c| above which a step does too little for the constraints
  double armijo = 1e-4;
  double smallest_step = 1e-14;  ///< where no shift helps
  /// Against the Maratos effect: where the full step is refused, correct it by the curvature of the constraints.
  bool second_order_correction = true;
};

/// Sequential quadratic programming after Byrd, Curtis and Nocedal 2010 (thesis 3.41 to 3.51): Newton's method on the
/// first-order conditions, made global by the merit f + mu |c|_1. A step is judged by the model of the merit (3.48);
/// the Hessian is shifted only where the step shows neither convexity nor normality (3.50), which takes no look at the
/// inertia, or where the line search cannot follow it. Exact Hessians where the programme has them, Gauss-Newton's
/// elsewhere. Equality constraints only: bounds are refused with InputError.
class Sqp : public Optimizer {
 public:
  explicit Sqp(const SqpOptions& options = {}) : options_(options) {}
  Solution minimize(const NonlinearProgram& program, const StopCriteria& stop = {},
                    const IterationObserver& observer = {}) const override;

 private:
  SqpOptions options_;
};

}  // namespace softform
