#pragma once

#include "softform/core/report.hpp"
#include "softform/core/types.hpp"
#include "softform/optimizers/nonlinear_program.hpp"

namespace softform {

/// When to stop, the same for every optimiser.
struct StopCriteria {
  int max_iterations = 200;
  double max_time_s = 3600;
  /// Relative decrease of the objective, summed over `patience` iterations, under which progress counts as over.
  double relative_decrease = 1e-3;
  int patience = 3;
  /// First-order optimality: largest entries of z - P(z - (f' + J^t lambda) / max(1, |f'|)) and of c, P the projection
  /// into the bounds.
  double tolerance = 1e-8;
};

/// The best point found, and how it was found.
struct Solution {
  Vec z;
  double objective = 0;
  Vec lagrange_multipliers;  ///< (constraint_count) of L = f + lambda . c; empty where the method has none
  Vec bound_multipliers;     ///< (variable_count) f' + J^t lambda: >= 0 at lower, <= 0 at upper bounds; empty likewise
  Report report;
};

/// A method for nonlinear programmes.
class Optimizer {
 public:
  virtual ~Optimizer() = default;
  virtual Solution minimize(const NonlinearProgram& program, const StopCriteria& stop = {},
                            const IterationObserver& observer = {}) const = 0;
};

}  // namespace softform
