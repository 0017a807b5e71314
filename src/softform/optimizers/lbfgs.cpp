#include "softform/optimizers/lbfgs.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "softform/core/interrupt.hpp"
#include "softform/linalg/sparse_factorization.hpp"
#include "softform/optimizers/counted_program.hpp"
#include "softform/optimizers/monitor.hpp"
#include "softform/optimizers/optimality.hpp"

namespace softform {
namespace {

struct Point {
  Vec z;
  double value;
  Vec gradient;
};

// The inverse of the programme's metric.
class Preconditioner {
 public:
  bool update(const NonlinearProgram& program, ConstVec z)
  {
    program.step_metric(z, D_);
    // Rigid motions have no length in a metric of shapes: a shift at round-off level holds them.
    SparseMatrix shift(D_.rows(), D_.cols());
    shift.setIdentity();
    shifted_ = D_ + 1e-8 * D_.diagonal().mean() * shift;
    return shifted_.coeffs().allFinite() && factorization_.cholesky(shifted_);
  }
  Vec apply(ConstVec v) const { return factorization_.solve(v); }

 private:
  SparseMatrix D_, shifted_;
  SparseFactorization factorization_;
};

class Run {
 public:
  Run(const NonlinearProgram& program, const LbfgsOptions& options, const StopCriteria& stop,
      const IterationObserver& observer)
      : program_(program, solution_.report.evaluations),
        options_(options),
        stop_(stop),
        monitor_(stop, observer, solution_.report)
  {}

  Solution minimize();

 private:
  struct Pair {
    Vec step, gradient_change;
  };

  bool evaluate(ConstVec z, Point& point) const;
  double stationarity() const;
  Vec direction();
  bool search(ConstVec d);
  void iterate();

  Solution solution_;
  CountedProgram program_;
  const LbfgsOptions& options_;
  const StopCriteria& stop_;
  Monitor monitor_;
  Point point_;
  std::deque<Pair> memory_;
  Preconditioner preconditioner_;
};

// Returns false where the value or the gradient is not finite.
bool Run::evaluate(ConstVec z, Point& point) const
{
  point.z = z;
  point.value = program_.objective(z);
  if (!std::isfinite(point.value)) return false;
  program_.objective_gradient(z, point.gradient);
  return point.gradient.allFinite();
}

double Run::stationarity() const
{
  const double slope = point_.gradient.cwiseAbs().maxCoeff();
  return slope / std::max(1.0, slope);
}

// The two-loop recursion.
Vec Run::direction()
{
  Vec q = -point_.gradient;
  std::vector<double> weights;
  for (auto pair = memory_.rbegin(); pair != memory_.rend(); ++pair) {
    weights.push_back(pair->step.dot(q) / pair->step.dot(pair->gradient_change));
    q -= weights.back() * pair->gradient_change;
  }
  Vec d = preconditioner_.apply(q);
  ++solution_.report.evaluations.linear_solve;
  if (!memory_.empty()) {
    const auto& [s, y] = memory_.back();
    d *= s.dot(y) / y.dot(preconditioner_.apply(y));
  }
  for (const auto& [s, y] : memory_) {
    d += (weights.back() - y.dot(d) / s.dot(y)) * s;
    weights.pop_back();
  }
  return d;
}

// Bisection for a point that satisfies the weak Wolfe conditions (Lewis and Overton 2013); the best that satisfies the
// first of them where the second cannot be had. Moves there; returns false when there is none.
bool Run::search(ConstVec d)
{
  const double slope = point_.gradient.dot(d), round_off = 1e-15 * std::abs(point_.value);
  double low = 0, high = HUGE_VAL, t = 1;
  Point trial, best = point_;
  for (int k = 0; k < options_.largest_search && !interrupted(); ++k) {
    const bool is_finite = evaluate(point_.z + t * d, trial);
    if (!is_finite || trial.value > point_.value + options_.sufficient_decrease * t * slope + round_off) {
      high = t;
    } else {
      low = t;
      best = trial;
      if (trial.gradient.dot(d) >= options_.slope_left * slope) break;
    }
    t = high < HUGE_VAL ? 0.5 * (low + high) : 2 * t;
  }
  if (low == 0) return false;
  Pair pair{best.z - point_.z, best.gradient - point_.gradient};
  if (pair.step.dot(pair.gradient_change) > 0) memory_.push_back(std::move(pair));
  if (memory_.size() > static_cast<std::size_t>(options_.memory)) memory_.pop_front();
  point_ = std::move(best);
  return true;
}

void Run::iterate()
{
  for (int k = 1; stationarity() > stop_.tolerance; ++k) {
    if (!preconditioner_.update(program_, point_.z)) {
      monitor_.finish(Termination::NotFinite, "the metric is not finite and positive semi-definite");
      return;
    }
    const Vec z = point_.z;
    bool found = search(direction());
    if (!found && !memory_.empty()) {
      memory_.clear();
      found = search(direction());
    }
    if (!found) {
      monitor_.finish(interrupted() ? Termination::Interrupted : Termination::Stalled,
                      fmt::format("no step lowers the objective; stationarity {:.1e}", stationarity()));
      return;
    }
    if (monitor_.record({k, point_.value, stationarity(), 0, (point_.z - z).norm(), 0}, &point_.z)) return;
  }
  monitor_.finish(Termination::Converged, fmt::format("stationarity {:.1e}", stationarity()));
}

Solution Run::minimize()
{
  if (!evaluate(program_.initial_point(), point_)) {
    monitor_.finish(Termination::NotFinite, "the objective or its gradient is not finite at the start");
  } else {
    if (!monitor_.record({0, point_.value, stationarity(), 0, 0, 0}, &point_.z)) iterate();
    solution_.bound_multipliers = Vec::Zero(point_.z.size());
  }
  solution_.z = point_.z;
  solution_.objective = point_.value;
  return std::move(solution_);
}

}  // namespace

Solution Lbfgs::minimize(const NonlinearProgram& program, const StopCriteria& stop,
                         const IterationObserver& observer) const
{
  require(program, "lbfgs", false, false);
  return Run(program, options_, stop, observer).minimize();
}

}  // namespace softform
