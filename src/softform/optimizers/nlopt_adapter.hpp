#pragma once

#include "softform/optimizers/optimizer.hpp"

namespace softform {

/// NLopt's methods with gradients. Slsqp: dense sequential least squares (equalities, bounds). Mma: conservative
/// approximations, for bounds alone (its inequalities cannot express an equality). Lbfgs: limited memory (bounds).
/// AugLag: augmented Lagrangian around L-BFGS (equalities, bounds).
enum class NloptMethod { Slsqp, Mma, Lbfgs, AugLag };

struct NloptOptions {
  /// Relative change of the variables at which NLopt stops: near round-off, for it looks at nothing else. A change of
  /// the objective would say little about constrained methods, where it is of second order at the end.
  double relative_tolerance = 1e-14;
  double feasibility_tolerance = 1e-9;
  /// NLopt counts evaluations where StopCriteria counts iterations; AugLag's inner minimisations take many.
  int evaluations_per_iteration = 20;
};

/// NLopt on our programmes. Its trace has a line for every gradient (it shows no iterations), and its multipliers are
/// the least-squares estimate at the point found, for it returns none. What it returns is evaluated again, and its
/// success believed only where the first-order conditions hold.
class NloptAdapter : public Optimizer {
 public:
  explicit NloptAdapter(NloptMethod method, const NloptOptions& options = {}) : method_(method), options_(options) {}
  Solution minimize(const NonlinearProgram& program, const StopCriteria& stop = {},
                    const IterationObserver& observer = {}) const override;

 private:
  NloptMethod method_;
  NloptOptions options_;
};

}  // namespace softform
