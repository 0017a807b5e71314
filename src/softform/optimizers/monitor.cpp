#include "softform/optimizers/monitor.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "softform/core/interrupt.hpp"

namespace softform {

double Monitor::elapsed_s() const
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
}

bool Monitor::finish(Termination termination, std::string message)
{
  report_.termination = termination;
  report_.message = std::move(message);
  return true;
}

// The best of the last `patience` feasible iterates against the best before them.
bool Monitor::has_little_progress() const
{
  if (stop_.relative_decrease <= 0) return false;
  const auto patience = static_cast<std::size_t>(stop_.patience);
  double before = HUGE_VAL, best = HUGE_VAL;
  std::size_t seen = 0;
  for (auto iterate = report_.trace.rbegin(); iterate != report_.trace.rend(); ++iterate) {
    if (iterate->infeasibility > feasibility_tolerance_) break;
    double& lowest = seen++ < patience ? best : before;
    lowest = std::min(lowest, iterate->objective);
  }
  return seen > patience && before - best < stop_.relative_decrease * std::abs(before);
}

bool Monitor::record(Iterate iterate, const Vec* z)
{
  iterate.elapsed_s = elapsed_s();
  iterate.linear_solves = report_.evaluations.linear_solve;
  report_.trace.push_back(iterate);
  iterate.z = z;
  if (!std::isfinite(iterate.objective) || !std::isfinite(iterate.infeasibility))
    return finish(Termination::NotFinite, "the objective or a constraint is not finite");
  if (iterate.objective < unbounded_objective)
    return finish(Termination::NotFinite, "the objective is unbounded below");
  if ((observer_ && !observer_(iterate)) || interrupted())
    return finish(Termination::Interrupted, fmt::format("interrupted after {} iterations", iterate.k));
  if (has_little_progress())
    return finish(Termination::Converged, fmt::format("the objective fell by less than {} of itself in {} iterations",
                                                      stop_.relative_decrease, stop_.patience));
  if (iterate.k >= stop_.max_iterations)
    return finish(Termination::IterationLimit, fmt::format("{} iterations", iterate.k));
  if (iterate.elapsed_s > stop_.max_time_s)
    return finish(Termination::TimeLimit, fmt::format("{:.0f} s", iterate.elapsed_s));
  return false;
}

}  // namespace softform
