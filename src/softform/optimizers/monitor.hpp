#pragma once

#include <chrono>
#include <string>

#include "softform/core/report.hpp"
#include "softform/optimizers/optimizer.hpp"

namespace softform {

/// The stopping rules that all methods share, applied to the trace that it writes.
class Monitor {
 public:
  /// All three outlive this object. Slow progress counts as convergence only at points whose infeasibility is below
  /// the tolerance.
  Monitor(const StopCriteria& stop, const IterationObserver& observer, Report& report, double feasibility_tolerance = 0)
      : stop_(stop), observer_(observer), report_(report), feasibility_tolerance_(feasibility_tolerance)
  {}

  /// Adds an iterate to the trace, with the time filled in, and shows it to the observer. Returns true when the method
  /// has to stop; the report then says why. z: the point, for the observer.
  bool record(Iterate iterate, const Vec* z = nullptr);
  /// Ends the report with an outcome of the method's own. Returns true, so that it can be returned like record().
  bool finish(Termination termination, std::string message);
  double elapsed_s() const;

 private:
  bool has_little_progress() const;

  const StopCriteria& stop_;
  const IterationObserver& observer_;
  Report& report_;
  double feasibility_tolerance_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

/// An objective below this counts as unbounded: no energy of ours comes near it.
constexpr double unbounded_objective = -1e15;

}  // namespace softform
