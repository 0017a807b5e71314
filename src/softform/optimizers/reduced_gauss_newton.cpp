#include "softform/optimizers/reduced_gauss_newton.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "softform/core/interrupt.hpp"
#include "softform/linalg/sparse_factorization.hpp"
#include "softform/optimizers/normal_matrix.hpp"

namespace softform {
namespace {

using Clock = std::chrono::steady_clock;

class Run {
 public:
  Run(const NonlinearProgram& program, const ReducedGaussNewtonOptions& options, const StopCriteria& stop,
      const IterationObserver& observer)
      : program_(program), options_(options), stop_(stop), observer_(observer), damping_(options.damping)
  {}

  Solution minimize();

 private:
  bool start();
  bool linearize();
  Vec step();
  bool try_step();
  bool is_finished(int k);
  bool has_little_progress() const;
  bool record(int k, double step_norm);
  double elapsed() const { return std::chrono::duration<double>(Clock::now() - begin_).count(); }
  void finish(Termination termination, std::string message);

  const NonlinearProgram& program_;
  const ReducedGaussNewtonOptions& options_;
  const StopCriteria& stop_;
  const IterationObserver& observer_;
  Clock::time_point begin_ = Clock::now();
  Solution solution_;
  double damping_;
  double step_norm_ = 0;
  Vec gradient_, constraints_, rhs_;
  SparseMatrix H_, J_, D_;
  NormalMatrix normal_;
  SparseFactorization factorization_;
};

void Run::finish(Termination termination, std::string message)
{
  solution_.report.termination = termination;
  solution_.report.message = std::move(message);
}

bool Run::start()
{
  const auto feasible = program_.restore(program_.initial_point());
  if (!feasible) {
    solution_.z = program_.initial_point();
    finish(Termination::Infeasible, "no feasible point at the initial design");
    return false;
  }
  solution_.z = *feasible;
  solution_.objective = program_.objective(solution_.z);
  return record(0, 0);
}

bool Run::record(int k, double step_norm)
{
  program_.constraints(solution_.z, constraints_);
  const double infeasibility = constraints_.size() > 0 ? constraints_.cwiseAbs().maxCoeff() : 0;
  const double stationarity = rhs_.size() > 0 ? rhs_.cwiseAbs().maxCoeff() : 0;
  solution_.report.trace.push_back({k, solution_.objective, stationarity, infeasibility, step_norm, elapsed(),
                                    solution_.report.evaluations.linear_solve});
  if (!std::isfinite(solution_.objective)) {
    finish(Termination::NotFinite, "the objective is not finite");
    return false;
  }
  if ((observer_ && !observer_(solution_.report.trace.back())) || interrupted()) {
    finish(Termination::Interrupted, fmt::format("interrupted after {} iterations", k));
    return false;
  }
  return true;
}

// Returns false when a derivative is not finite.
bool Run::linearize()
{
  auto& count = solution_.report.evaluations;
  program_.objective_gradient(solution_.z, gradient_);
  program_.constraints(solution_.z, constraints_);
  program_.constraint_jacobian(solution_.z, J_);
  program_.gauss_newton_hessian(solution_.z, H_);
  program_.step_metric(solution_.z, D_);
  rhs_ = -gradient_ - options_.constraint_weight * (J_.transpose() * constraints_);
  const SparseMatrix& A = normal_.assemble(H_, J_, options_.constraint_weight, D_, damping_);
  ++count.gradient;
  ++count.jacobian;
  ++count.hessian;
  return rhs_.allFinite() && A.coeffs().allFinite();
}

Vec Run::step()
{
  while (!factorization_.cholesky(normal_.with_damping(D_, damping_))) damping_ *= options_.damping_increase;
  ++solution_.report.evaluations.linear_solve;
  return factorization_.solve(rhs_);
}

// Raises the damping until a step decreases the objective of the restored point.
bool Run::try_step()
{
  while (damping_ <= options_.largest_damping) {
    const Vec dz = step();
    const auto restored = program_.restore(solution_.z + dz);
    ++solution_.report.evaluations.constraint;
    if (interrupted()) return false;
    const double objective = restored ? program_.objective(*restored) : HUGE_VAL;
    ++solution_.report.evaluations.value;
    if (objective < solution_.objective) {
      const double predicted = -(gradient_.dot(dz) + 0.5 * dz.dot(H_ * dz));
      const double ratio = (solution_.objective - objective) / predicted;
      if (ratio > 0.5) damping_ = damping_ * options_.damping_decrease;
      if (ratio < 0.1) damping_ *= 2;
      step_norm_ = (*restored - solution_.z).norm();
      solution_.z = *restored;
      solution_.objective = objective;
      return true;
    }
    damping_ *= options_.damping_increase;
  }
  return false;
}

bool Run::has_little_progress() const
{
  const auto& trace = solution_.report.trace;
  const auto patience = static_cast<std::size_t>(stop_.patience);
  if (trace.size() <= patience) return false;
  double before = HUGE_VAL, best = HUGE_VAL;
  for (std::size_t k = 0; k < trace.size(); ++k) {
    if (k < trace.size() - patience) before = std::min(before, trace[k].objective);
    best = std::min(best, trace[k].objective);
  }
  return before - best < stop_.relative_decrease * std::abs(before);
}

bool Run::is_finished(int k)
{
  if (has_little_progress()) {
    finish(Termination::Converged, fmt::format("the objective fell by less than {} of itself in {} iterations",
                                               stop_.relative_decrease, stop_.patience));
  } else if (k >= stop_.max_iterations) {
    finish(Termination::IterationLimit, fmt::format("{} iterations", k));
  } else if (elapsed() > stop_.max_time_s) {
    finish(Termination::TimeLimit, fmt::format("{:.0f} s", elapsed()));
  } else {
    return false;
  }
  return true;
}

Solution Run::minimize()
{
  if (!start()) return std::move(solution_);
  for (int k = 1; !is_finished(k - 1); ++k) {
    if (!linearize()) {
      finish(Termination::NotFinite, "a derivative is not finite");
      break;
    }
    if (!try_step()) {
      if (interrupted())
        finish(Termination::Interrupted, fmt::format("interrupted after {} iterations", k - 1));
      else
        finish(Termination::Stalled, "no step decreases the objective, however small");
      break;
    }
    if (!record(k, step_norm_)) break;
  }
  return std::move(solution_);
}

}  // namespace

Solution ReducedGaussNewton::minimize(const NonlinearProgram& program, const StopCriteria& stop,
                                      const IterationObserver& observer) const
{
  return Run(program, options_, stop, observer).minimize();
}

}  // namespace softform
