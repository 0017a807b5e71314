#include "softform/optimizers/augmented_lagrangian.hpp"

#include <chrono>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "softform/core/interrupt.hpp"
#include "softform/linalg/sparse_factorization.hpp"
#include "softform/optimizers/normal_matrix.hpp"

namespace softform {
namespace {

using Clock = std::chrono::steady_clock;

class Run {
 public:
  Run(const NonlinearProgram& program, const AugmentedLagrangianOptions& options, const StopCriteria& stop,
      const IterationObserver& observer)
      : program_(program),
        options_(options),
        stop_(stop),
        observer_(observer),
        penalty_(options.penalty),
        damping_(options.damping)
  {
    solution_.z = program.initial_point();
    multipliers_.setZero(program.constraint_count());
  }

  Solution minimize();

 private:
  double lagrangian(ConstVec z);
  bool minimize_lagrangian();
  bool linearize();
  bool try_step();
  bool record();
  bool is_out_of_budget();
  void restore();
  double infeasibility() const { return constraints_.size() > 0 ? constraints_.cwiseAbs().maxCoeff() : 0; }
  double elapsed() const { return std::chrono::duration<double>(Clock::now() - begin_).count(); }
  void finish(Termination termination, std::string message);

  const NonlinearProgram& program_;
  const AugmentedLagrangianOptions& options_;
  const StopCriteria& stop_;
  const IterationObserver& observer_;
  Clock::time_point begin_ = Clock::now();
  Solution solution_;
  Vec multipliers_, constraints_, gradient_, rhs_;  // constraints_ are those of solution_.z
  double penalty_, damping_, value_ = 0, step_norm_ = 0;
  int iterations_ = 0;
  SparseMatrix H_, J_, D_;
  NormalMatrix normal_;
  SparseFactorization factorization_;
};

void Run::finish(Termination termination, std::string message)
{
  solution_.report.termination = termination;
  solution_.report.message = std::move(message);
}

// L(z); leaves c(z) in constraints_ and f(z) in solution_.objective.
double Run::lagrangian(ConstVec z)
{
  solution_.objective = program_.objective(z);
  program_.constraints(z, constraints_);
  ++solution_.report.evaluations.value;
  return solution_.objective - multipliers_.dot(constraints_) + 0.5 * penalty_ * constraints_.squaredNorm();
}

// Returns false when a derivative is not finite.
bool Run::linearize()
{
  program_.objective_gradient(solution_.z, gradient_);
  program_.gauss_newton_hessian(solution_.z, H_);
  program_.constraint_jacobian(solution_.z, J_);
  program_.step_metric(solution_.z, D_);
  rhs_ = -gradient_ + J_.transpose() * (multipliers_ - penalty_ * constraints_);
  const SparseMatrix& A = normal_.assemble(H_, J_, penalty_, D_, damping_);
  auto& count = solution_.report.evaluations;
  ++count.gradient;
  ++count.jacobian;
  ++count.hessian;
  return rhs_.allFinite() && A.coeffs().allFinite();
}

// Raises the damping until a step decreases L. Returns false when none does.
bool Run::try_step()
{
  const Vec z = solution_.z;
  for (; damping_ <= options_.largest_damping; damping_ *= options_.damping_increase) {
    if (interrupted()) break;
    if (!factorization_.cholesky(normal_.with_damping(D_, damping_))) continue;
    ++solution_.report.evaluations.linear_solve;
    const Vec dz = factorization_.solve(rhs_);
    const double predicted = 0.5 * dz.dot(rhs_ + damping_ * (D_ * dz));
    const double value = lagrangian(z + dz);
    if (value < value_) {
      if (value_ - value > 0.5 * predicted) damping_ *= options_.damping_decrease;
      solution_.z = z + dz;
      step_norm_ = dz.norm();
      return true;
    }
  }
  value_ = lagrangian(z);
  return false;
}

bool Run::record()
{
  solution_.report.trace.push_back({iterations_, solution_.objective, rhs_.size() > 0 ? rhs_.cwiseAbs().maxCoeff() : 0,
                                    infeasibility(), step_norm_, elapsed()});
  return (!observer_ || observer_(solution_.report.trace.back())) && !interrupted();
}

bool Run::is_out_of_budget()
{
  if (iterations_ >= stop_.max_iterations) {
    finish(Termination::IterationLimit, fmt::format("{} iterations", iterations_));
  } else if (elapsed() > stop_.max_time_s) {
    finish(Termination::TimeLimit, fmt::format("{:.0f} s", elapsed()));
  } else {
    return false;
  }
  return true;
}

// Until L falls by little. Returns false when the whole run has to end.
bool Run::minimize_lagrangian()
{
  value_ = lagrangian(solution_.z);
  for (;;) {
    if (is_out_of_budget()) return false;
    if (!std::isfinite(value_) || !linearize()) {
      finish(Termination::NotFinite, "the Lagrangian or a derivative is not finite");
      return false;
    }
    const double before = value_;
    if (!try_step()) {
      damping_ = options_.damping;
      return !interrupted();
    }
    ++iterations_;
    value_ = lagrangian(solution_.z);
    if (!record()) {
      finish(Termination::Interrupted, fmt::format("interrupted after {} iterations", iterations_));
      return false;
    }
    if (before - value_ <= stop_.relative_decrease * std::abs(value_)) return true;
  }
}

void Run::restore()
{
  const auto feasible = program_.restore(solution_.z);
  if (!feasible) return;
  solution_.z = *feasible;
  solution_.objective = program_.objective(*feasible);
  program_.constraints(*feasible, constraints_);
}

Solution Run::minimize()
{
  double allowed = HUGE_VAL;
  while (minimize_lagrangian()) {
    const double violation = infeasibility();
    if (violation <= options_.feasibility) {
      finish(Termination::Converged,
             fmt::format("largest constraint {:.1e} after {} iterations", violation, iterations_));
      break;
    }
    if (violation <= allowed) {
      multipliers_ -= penalty_ * constraints_;  // (3.53)
      allowed = options_.sufficient_decrease * violation;
    } else if (penalty_ < options_.largest_penalty) {
      penalty_ *= options_.penalty_increase;
    } else {
      finish(Termination::Infeasible, fmt::format("largest constraint {:.1e} at the largest penalty", violation));
      break;
    }
  }
  restore();
  return std::move(solution_);
}

}  // namespace

Solution AugmentedLagrangian::minimize(const NonlinearProgram& program, const StopCriteria& stop,
                                       const IterationObserver& observer) const
{
  return Run(program, options_, stop, observer).minimize();
}

}  // namespace softform
