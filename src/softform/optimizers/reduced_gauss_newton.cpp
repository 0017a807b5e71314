#include "softform/optimizers/reduced_gauss_newton.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "softform/core/interrupt.hpp"
#include "softform/core/stopwatch.hpp"
#include "softform/linalg/nonnegative_quadratic.hpp"
#include "softform/linalg/sparse_factorization.hpp"
#include "softform/optimizers/counted_program.hpp"
#include "softform/optimizers/feasible_iterate.hpp"
#include "softform/optimizers/monitor.hpp"
#include "softform/optimizers/normal_matrix.hpp"

namespace softform {
namespace {

class Run {
 public:
  Run(const NonlinearProgram& program, const ReducedGaussNewtonOptions& options, const StopCriteria& stop,
      const IterationObserver& observer)
      : stop_(stop),
        program_(program, solution_.report.evaluations),
        options_(options),
        // Every iterate is as feasible as the programme makes it.
        monitor_(stop, observer, solution_.report, HUGE_VAL),
        damping_(options.damping)
  {}

  Solution minimize();

 private:
  bool start();
  bool linearize();
  Vec step();
  Vec bounded_step(const Vec& dz);
  bool try_step();
  bool record(int k, double step_norm);

  const StopCriteria& stop_;
  Solution solution_;
  CountedProgram program_;
  FeasibleIterate iterate_{program_, solution_};
  const ReducedGaussNewtonOptions& options_;
  Monitor monitor_;
  double damping_;
  bool is_exhausted_ = false;  // the last step's model promised too little to go on
  Vec gradient_, constraints_, rhs_, lower_, upper_;
  SparseMatrix H_, J_, D_;
  NormalMatrix normal_;
  SparseFactorization factorization_;
};

bool Run::start()
{
  lower_ = program_.lower_bounds();
  upper_ = program_.upper_bounds();
  const Vec z = program_.initial_point().cwiseMax(lower_).cwiseMin(upper_);
  if (!iterate_.start(z)) return !monitor_.finish(Termination::Infeasible, "no feasible point at the initial design");
  return record(0, 0);
}

// Returns false when the run has to end.
bool Run::record(int k, double step_norm)
{
  program_.constraints(solution_.z, constraints_);
  const double infeasibility = constraints_.size() > 0 ? constraints_.cwiseAbs().maxCoeff() : 0;
  const Vec& z = solution_.z;
  const double stationarity =
      rhs_.size() > 0 ? ((z + rhs_).cwiseMax(lower_).cwiseMin(upper_) - z).lpNorm<Eigen::Infinity>() : 0;
  return !monitor_.record({k, solution_.objective, stationarity, infeasibility, step_norm, 0}, &z);
}

// Returns false when a derivative is not finite.
bool Run::linearize()
{
  const Stopwatch watch(solution_.report.times.assembly);
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
  PhaseTimes& times = solution_.report.times;
  int& linear_solves = solution_.report.evaluations.linear_solve;
  {
    const Stopwatch watch(times.factorization);
    for (++linear_solves; !factorization_.cholesky(normal_.with_damping(D_, damping_)); ++linear_solves)
      damping_ *= options_.damping_increase;
  }
  const Stopwatch watch(times.solve);
  return bounded_step(factorization_.solve(rhs_));
}

// The model's minimum within the bounds, from its free minimum dz. With the bounded entries' bounds as  S dz >= gap, S
// of rows +-e_k, it is dz + A^-1 S^t y, where y >= 0 minimises  1/2 y^t (S A^-1 S^t) y + (S dz - gap)^t y.
Vec Run::bounded_step(const Vec& dz)
{
  const Vec to_lower = lower_ - solution_.z, to_upper = upper_ - solution_.z;
  const Vec within = dz.cwiseMax(to_lower).cwiseMin(to_upper);
  if (within == dz) return dz;
  std::vector<Eigen::Index> entries;
  std::vector<double> signs, slacks;
  const auto add = [&](Eigen::Index k, double sign, double gap) {
    if (!std::isfinite(gap)) return;
    entries.push_back(k);
    signs.push_back(sign);
    slacks.push_back(sign * (dz[k] - gap));
  };
  for (Eigen::Index k = 0; k < dz.size(); ++k) {
    add(k, 1, to_lower[k]);
    add(k, -1, to_upper[k]);
  }
  if (entries.empty()) return dz;
  const Eigen::Index count = static_cast<Eigen::Index>(entries.size());
  Eigen::MatrixXd responses(dz.size(), count);
  for (Eigen::Index r = 0; r < count; ++r) {
    const auto row = static_cast<std::size_t>(r);
    responses.col(r) = factorization_.solve(signs[row] * Vec::Unit(dz.size(), entries[row]));
  }
  const Eigen::Map<const Vec> sign(signs.data(), count), slack(slacks.data(), count);
  const Eigen::MatrixXd M = sign.asDiagonal() * responses(entries, Eigen::all);
  const Vec multipliers = nonnegative_minimum(M, slack);
  Vec bounded = dz + responses * multipliers;
  for (Eigen::Index r = 0; r < count; ++r) {
    const Eigen::Index k = entries[static_cast<std::size_t>(r)];
    if (multipliers[r] > 0) bounded[k] = sign[r] > 0 ? to_lower[k] : to_upper[k];
  }
  return bounded.cwiseMax(to_lower).cwiseMin(to_upper);
}

// Halves a step that does not decrease the objective, which costs no factorisation, before it raises the damping.
bool Run::try_step()
{
  for (bool is_first = true; damping_ <= options_.largest_damping; is_first = false) {
    const Vec dz = step();
    const double slope = gradient_.dot(dz), curvature = dz.dot(H_ * dz), damping = damping_ * dz.dot(D_ * dz);
    double length = 1;
    for (int halving = 0; halving <= options_.halvings; ++halving, length /= 2) {
      if (interrupted()) return false;
      if (!iterate_.accepts(length * dz)) continue;
      const double predicted = -length * (slope + 0.5 * length * curvature), ratio = iterate_.decrease() / predicted;
      // Damping that is a small part of the model's curvature does not hide any decrease that there is.
      is_exhausted_ = length == 1 && ratio > 0.25 && damping < curvature &&
                      predicted < stop_.relative_decrease / stop_.patience * solution_.objective;
      if (length < 1 || ratio < 0.1)
        damping_ *= 2 / length;
      else if (ratio > 0.5 && is_first)
        damping_ *= options_.damping_decrease;
      return true;
    }
    damping_ *= options_.damping_increase / (2 * length);  // length is that of one halving more than was tried
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
    if (!record(k, iterate_.step_norm())) break;
    if (is_exhausted_) {
      monitor_.finish(Termination::Converged, fmt::format("the model promised a decrease of less than {:.1g} of itself",
                                                          stop_.relative_decrease / stop_.patience));
      break;
    }
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
