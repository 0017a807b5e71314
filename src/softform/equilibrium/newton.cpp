#include "softform/equilibrium/newton.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "softform/core/stopwatch.hpp"
#include "softform/equilibrium/newton_iteration.hpp"

namespace softform {

void FixedDofs::project(SparseMatrix& K, double diagonal) const
{
  if (free.size() == 0) return;
  for (int j = 0; j < K.outerSize(); ++j) {
    for (SparseMatrix::InnerIterator entry(K, j); entry; ++entry) {
      if (free[entry.row()] * free[j] == 0) entry.valueRef() = entry.row() == j ? diagonal : 0;
    }
  }
}

double largest_nodal_norm(ConstVec g, int dimension)
{
  const Eigen::Map<const Eigen::MatrixXd> columns(g.data(), dimension, g.size() / dimension);
  return std::sqrt(columns.colwise().squaredNorm().maxCoeff());
}

void shift_diagonal(SparseMatrix& K, double shift)
{
  for (int j = 0; j < K.outerSize(); ++j) K.coeffRef(j, j) += shift;
}

int count_negative_eigenvalues(SparseMatrix K, SparseFactorization& factorization)
{
  if (!K.coeffs().allFinite()) return -1;
  shift_diagonal(K, 1e-8 * K.diagonal().cwiseAbs().mean());
  if (factorization.cholesky(K)) return 0;
  factorization.indefinite(K);
  return factorization.negative_eigenvalues();
}

namespace {

// The state of one Newton solve.
class NewtonSolve {
 public:
  NewtonSolve(const Potential& potential, const Vec& x0, SparseFactorization& factorization,
              const NewtonOptions& options, const FixedDofs& fixed)
      : potential_(potential), factorization_(factorization), options_(options), fixed_(fixed), shift_(options)
  {
    result_.x = x0;
  }

  Equilibrium run();

 private:
  void evaluate_forces();
  bool factorize_shifted();
  bool factorize(double mean_diagonal);
  bool cholesky();
  Vec newton_step();
  bool creeps() const;
  std::optional<double> line_search(const Vec& dx);

  const Potential& potential_;
  SparseFactorization& factorization_;
  const NewtonOptions& options_;
  const FixedDofs& fixed_;
  Equilibrium result_;
  double energy_ = 0;
  TangentShift shift_;
  bool is_definite_ = true;  // the last tangent factorised, before any modification
  // Steps in a row whose decrease of the energy is lost in round-off, and which did not lower this residual by a tenth.
  int creeping_ = 0;
  double creep_residual_ = HUGE_VAL;
  Vec g_, trial_, trial_g_;
  SparseMatrix K_;
};

void NewtonSolve::evaluate_forces()
{
  const Stopwatch watch(result_.report.times.assembly);
  potential_.gradient(result_.x, g_);
  fixed_.project(g_);
  result_.residual = largest_nodal_norm(g_, potential_.dimension()) / potential_.force_scale();
  ++result_.report.evaluations.gradient;
}

// Returns false when the tangent is not finite, which no shift mends.
bool NewtonSolve::factorize_shifted()
{
  {
    const Stopwatch watch(result_.report.times.assembly);
    potential_.hessian(result_.x, K_);
  }
  ++result_.report.evaluations.hessian;
  const double mean_diagonal = K_.diagonal().cwiseAbs().mean();
  if (!std::isfinite(mean_diagonal)) return false;
  is_definite_ = factorize(mean_diagonal);
  if (is_definite_) return true;
  if (potential_.projected_hessian(result_.x, K_) && factorize(mean_diagonal)) return true;
  while (!shift_.is_hopeless()) {
    shift_diagonal(K_, shift_.raise() * mean_diagonal);
    if (cholesky()) return true;
  }
  return false;
}

bool NewtonSolve::factorize(double mean_diagonal)
{
  fixed_.project(K_, mean_diagonal);
  shift_diagonal(K_, (options_.rigid_shift + shift_.value()) * mean_diagonal);
  return cholesky();
}

bool NewtonSolve::cholesky()
{
  const Stopwatch watch(result_.report.times.factorization);
  ++result_.report.evaluations.linear_solve;
  return factorization_.cholesky(K_);
}

Vec NewtonSolve::newton_step()
{
  const Stopwatch watch(result_.report.times.solve);
  return -factorization_.solve(g_);
}

// Forces at their round-off can be lowered a little for ever.
bool NewtonSolve::creeps() const
{
  constexpr int patience = 20;
  return creeping_ >= patience;
}

// Backtracking on the energy; once the predicted decrease is lost in round-off, on the forces.
std::optional<double> NewtonSolve::line_search(const Vec& dx)
{
  const Stopwatch watch(result_.report.times.assembly);
  const double slope = g_.dot(dx);
  const bool is_round_off = std::abs(slope) < 1e-11 * std::abs(energy_);
  double step =
      std::min(1.0, options_.step_cap * potential_.length_scale() / largest_nodal_norm(dx, potential_.dimension()));
  for (int backtrack = 0; backtrack < 30; ++backtrack, step /= 2) {
    trial_ = result_.x + step * dx;
    const double energy = potential_.value(trial_);
    ++result_.report.evaluations.value;
    if (!std::isfinite(energy)) continue;
    bool accepted = energy <= energy_ + options_.armijo * step * slope;
    if (!accepted && is_round_off) {
      potential_.gradient(trial_, trial_g_);
      fixed_.project(trial_g_);
      accepted = trial_g_.norm() < g_.norm();
    }
    if (accepted) {
      const bool is_better = !is_round_off || result_.residual < 0.9 * creep_residual_;
      creeping_ = is_better ? 0 : creeping_ + 1;
      if (is_better) creep_residual_ = result_.residual;
      result_.x.swap(trial_);
      energy_ = energy;
      return step;
    }
  }
  return std::nullopt;
}

Equilibrium NewtonSolve::run()
{
  energy_ = potential_.value(result_.x);
  for (int k = 0;; ++k) {
    evaluate_forces();
    result_.report.trace.push_back({k, energy_, result_.residual, 0, 0, 0});
    const bool is_balanced = result_.residual <= options_.tolerance && is_definite_ && shift_.value() == 0;
    if (is_finished(result_, k, energy_, is_balanced, options_)) break;
    if (!factorize_shifted()) {
      finish(result_, Termination::NotFinite, "the tangent is not finite");
      break;
    }
    const auto step = creeps() ? std::nullopt : line_search(newton_step());
    if (!step) {
      const bool is_round_off = is_definite_ && shift_.value() == 0 && result_.residual <= 100 * options_.tolerance;
      finish(result_, is_round_off ? Termination::Converged : Termination::Stalled,
             fmt::format("no decrease along the Newton step, residual {:.1e}", result_.residual));
      break;
    }
    if (*step == 1) shift_.relax(result_.residual);
  }
  return std::move(result_);
}

}  // namespace

Equilibrium solve_equilibrium(const Potential& potential, const Vec& x0, SparseFactorization& factorization,
                              const NewtonOptions& options, const FixedDofs& fixed)
{
  return NewtonSolve(potential, x0, factorization, options, fixed).run();
}

}  // namespace softform
