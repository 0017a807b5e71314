#pragma once

#include "softform/optimizers/optimizer.hpp"

namespace softform {

struct CeresOptions {
  double function_tolerance = 1e-14;   ///< relative decrease of the cost at which Ceres stops: near round-off
  double parameter_tolerance = 1e-14;  ///< relative length of a step, likewise
};

/// Ceres' trust-region Levenberg-Marquardt for a LeastSquaresProgram, free or within bounds. Any other programme is
/// refused with InputError. The Jacobian is one dense block: for up to some hundred variables.
///
/// Ceres projects its steps into the bounds but predicts their decrease without, so that its trust region collapses at
/// active bounds. Therefore the variables that the gradient presses against their bounds are held there, Ceres
/// minimises over the others, and this is repeated until the set of held ones stays.
class CeresAdapter : public Optimizer {
 public:
  explicit CeresAdapter(const CeresOptions& options = {}) : options_(options) {}
  Solution minimize(const NonlinearProgram& program, const StopCriteria& stop = {},
                    const IterationObserver& observer = {}) const override;

 private:
  CeresOptions options_;
};

}  // namespace softform
