#pragma once

#include "softform/optimizers/monitor.hpp"
#include "softform/optimizers/optimality.hpp"

/// Steepest descent with backtracking, for programmes without constraints and bounds.
class SteepestDescent : public softform::Optimizer {
 public:
  softform::Solution minimize(const softform::NonlinearProgram& program, const softform::StopCriteria& stop = {},
                              const softform::IterationObserver& observer = {}) const override
  {
    softform::require(program, "steepest_descent", false, false);  // throws InputError
    softform::Solution solution;
    softform::Monitor monitor(stop, observer, solution.report);  // trace, limits, observer, Ctrl-C, NaN
    softform::Vec& z = solution.z = program.initial_point();
    softform::Vec g;
    double f = program.objective(z), step = 1, norm = 0;
    for (int k = 0;; ++k) {
      program.objective_gradient(z, g);
      const double stationarity = g.lpNorm<Eigen::Infinity>();
      if (monitor.record({k, f, stationarity, 0, norm, 0})) break;
      if (stationarity < stop.tolerance && monitor.finish(softform::Termination::Converged, "stationary")) break;
      while (step > 1e-20 && !(program.objective(z - step * g) < f)) step /= 2;  // refuses NaN
      z -= step * g;
      f = program.objective(z);
      norm = step * g.norm();
      step *= 4;
    }
    softform::judge(program, {}, solution);  // evaluates again, fills in multipliers, corrects false claims
    return solution;
  }
};
