#include "softform/optimizers/reduced_gauss_newton.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "softform/core/interrupt.hpp"
#include "softform/linalg/sparse_factorization.hpp"
#include "softform/optimizers/counted_program.hpp"
#include "softform/optimizers/monitor.hpp"
#include "softform/optimizers/normal_matrix.hpp"

namespace softform {
namespace {

class Run {
 public:
  Run(const NonlinearProgram& program, const ReducedGaussNewtonOptions& options, const StopCriteria& stop,
      const IterationObserver& observer)
      // Every iterate is as feasible as the programme makes it.
      : program_(program, solution_.report.evaluations),
        options_(options),
        monitor_(stop, observer, solution_.report, HUGE_VAL),
        damping_(options.damping)
  {}

  Solution minimize();

 private:
  bool start();
  bool linearize();
  Vec step();
  bool try_step();
  bool record(int k, double step_norm);

  Solution solution_;
  CountedProgram program_;
  const ReducedGaussNewtonOptions& options_;
  Monitor monitor_;
  double damping_;
  double step_norm_ = 0;
  Vec gradient_, constraints_, rhs_;
  SparseMatrix H_, J_, D_;
  NormalMatrix normal_;
  SparseFactorization factorization_;
};

bool Run::start()
{
  const auto feasible = program_.restore(program_.initial_point());
  if (!feasible) {
    solution_.z = program_.initial_point();
    monitor_.finish(Termination::Infeasible, "no feasible point at the initial design");
    return false;
  }
  solution_.z = *feasible;
  solution_.objective = program_.objective(solution_.z);
  return record(0, 0);
}

// Returns false when the run has to end.
bool Run::record(int k, double step_norm)
{
  program_.constraints(solution_.z, constraints_);
  const double infeasibility = constraints_.size() > 0 ? constraints_.cwiseAbs().maxCoeff() : 0;
  const double stationarity = rhs_.size() > 0 ? rhs_.cwiseAbs().maxCoeff() : 0;
  return !monitor_.record({k, solution_.objective, stationarity, infeasibility, step_norm, 0});
}

// Returns false when a derivative is not finite.
bool Run::linearize()
{
  program_.objective_gradient(solution_.z, gradient_);
  program_.constraints(solution_.z, constraints_);
  program_.constraint_jacobian(solution_.z, J_);
  program_.gauss_newton_hessian(solution_.z, H_);
  program_.step_metric(solution_.z, D_);
  rhs_ = -gradient_ - options_.constraint_weight * (J_.transpose() * constraints_);
  const SparseMatrix& A = normal_.assemble(H_, J_, options_.constraint_weight, D_, damping_);
  return rhs_.allFinite() && A.coeffs().allFinite();
}

Vec Run::step()
{
  int& linear_solves = solution_.report.evaluations.linear_solve;
  for (++linear_solves; !factorization_.cholesky(normal_.with_damping(D_, damping_)); ++linear_solves)
    damping_ *= options_.damping_increase;
  return factorization_.solve(rhs_);
}

// Raises the damping until a step decreases the objective of the restored point.
bool Run::try_step()
{
  while (damping_ <= options_.largest_damping) {
    const Vec dz = step();
    const auto restored = program_.restore(solution_.z + dz);
    if (interrupted()) return false;
    const double objective = restored ? program_.objective(*restored) : HUGE_VAL;
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

Solution Run::minimize()
{
  if (!start()) return std::move(solution_);
  for (int k = 1;; ++k) {
    if (!linearize()) {
      monitor_.finish(Termination::NotFinite, "a derivative is not finite");
      break;
    }
    if (!try_step()) {
      if (interrupted())
        monitor_.finish(Termination::Interrupted, fmt::format("interrupted after {} iterations", k - 1));
      else
        monitor_.finish(Termination::Stalled, "no step decreases the objective, however small");
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
