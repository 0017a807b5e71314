#include <algorithm>
#include <chrono>
#include <cmath>

#include <Eigen/QR>
#include <fmt/format.h>

#include "softform/fitting/least_squares.hpp"

namespace softform {
namespace {

using Clock = std::chrono::steady_clock;

/// The step s of min |J s + r|^2 + mu |D s|^2, by QR: the normal equations would square the condition number.
Vec damped_step(const Eigen::MatrixXd& J, const Vec& r, const Vec& D, double mu)
{
  const Eigen::Index m = J.rows(), n = J.cols();
  Eigen::MatrixXd A(m + n, n);
  A << J, Eigen::MatrixXd((std::sqrt(mu) * D).asDiagonal());
  Vec b = Vec::Zero(m + n);
  b.head(m) = -r;
  return A.colPivHouseholderQr().solve(b);
}

/// Column norms of the Jacobian, the largest seen so far (More 1978): steps are judged in the problem's own scales.
void update_scales(const Eigen::MatrixXd& J, Vec& D)
{
  D = D.cwiseMax(J.colwise().norm().transpose());
  for (double& d : D)
    if (d == 0) d = 1;
}

/// Nielsen's rule (1999): the damping follows how well the linear model predicted the cost. A pure number, for D is in
/// the scale of J.
struct Damping {
  double mu = 1e-3, growth = 2;

  void relax(double gain)
  {
    mu *= std::max(1.0 / 3, 1 - std::pow(2 * gain - 1, 3));
    growth = 2;
  }
  void tighten()
  {
    mu *= growth;
    growth *= 2;
  }
};

}  // namespace

LeastSquaresSolution minimize_by_gauss_newton(const LeastSquaresProblem& problem, ConstVec start,
                                              const LeastSquaresOptions& options)
{
  const auto begin = Clock::now();
  LeastSquaresSolution solution;
  solution.z = start;
  Report& report = solution.report;
  Vec r, trial_r;
  Eigen::MatrixXd J;
  if (!problem.evaluate(start, r, &J)) {
    report.termination = Termination::NotFinite;
    report.message = "the residuals are not finite at the start";
    return solution;
  }
  solution.cost = 0.5 * r.squaredNorm();
  Vec D = Vec::Zero(start.size());
  Damping damping;
  int k = 0;
  for (bool is_done = false; !is_done && k < options.max_iterations; ++k) {
    update_scales(J, D);
    const Vec step = damped_step(J, r, D, damping.mu);
    const Vec trial = solution.z + step;
    const double trial_cost = problem.evaluate(trial, trial_r, nullptr) ? 0.5 * trial_r.squaredNorm() : HUGE_VAL;
    const double predicted = solution.cost - 0.5 * (r + J * step).squaredNorm(), actual = solution.cost - trial_cost;
    ++report.evaluations.linear_solve;
    ++report.evaluations.value;
    const bool is_at_round_off = predicted < options.tolerance * solution.cost;
    if (actual > 0) {
      is_done = is_at_round_off && actual < options.tolerance * solution.cost && damping.mu < 1;
      solution.z = trial;
      solution.cost = trial_cost;
      problem.evaluate(trial, r, &J);
      ++report.evaluations.jacobian;
      damping.relax(actual / predicted);
      const double elapsed = std::chrono::duration<double>(Clock::now() - begin).count();
      report.trace.push_back({k, trial_cost, 0, 0, step.norm(), elapsed});
    } else {
      is_done = is_at_round_off || damping.mu > 1e20;
      damping.tighten();
    }
  }
  report.termination = k < options.max_iterations ? Termination::Converged : Termination::IterationLimit;
  report.message = fmt::format("{} iterations", k);
  judge(problem, solution);
  return solution;
}

}  // namespace softform
