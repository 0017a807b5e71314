#pragma once

#include "softform/optimizers/optimizer.hpp"

namespace softform {

struct LbfgsOptions {
  /// Pairs of steps and gradient changes that are kept: beyond some ten, more rarely help.
  int memory = 10;
  /// The weak Wolfe conditions (Nocedal and Wright 2000, 3.6): share of the predicted decrease, and of the slope left.
  double sufficient_decrease = 1e-4;
  double slope_left = 0.9;
  /// Evaluations in a line search before it gives up; the interval halves at each.
  int largest_search = 50;
};

/// Limited-memory BFGS (Nocedal and Wright 2000, 9.1) for programmes without constraints and bounds, where a second
/// derivative is dear: the reduced problems of design. The first inverse Hessian of every two-loop recursion is that of
/// the programme's step metric, scaled. Objectives that are infinite outside a domain are backed away from.
/// Throws InputError where there are constraints or bounds.
class Lbfgs : public Optimizer {
 public:
  explicit Lbfgs(LbfgsOptions options = {}) : options_(options) {}
  Solution minimize(const NonlinearProgram& program, const StopCriteria& stop = {},
                    const IterationObserver& observer = {}) const override;

 private:
  LbfgsOptions options_;
};

}  // namespace softform
