#pragma once

#include "softform/optimizers/optimizer.hpp"
#include "softform/optimizers/projected_newton.hpp"

namespace softform {

/// The gradient projection method (3.54, 3.55) for programmes with bounds and without constraints: ProjectedNewton on
/// the objective. Throws InputError where there are constraints.
class GradientProjection : public Optimizer {
 public:
  explicit GradientProjection(ProjectedNewtonOptions options = {}) : options_(options) {}
  Solution minimize(const NonlinearProgram& program, const StopCriteria& stop = {},
                    const IterationObserver& observer = {}) const override;

 private:
  ProjectedNewtonOptions options_;
};

}  // namespace softform
