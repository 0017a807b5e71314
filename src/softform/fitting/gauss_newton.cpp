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
  Vec D = Vec::Zero(start.size());
  update_scales(J, D);
  solution.cost = 0.5 * r.squaredNorm();
  double mu = 1e-3, growth = 2;  // D is in the scale of J: mu is a pure number
  int k = 0;
  for (; k < options.max_iterations; ++k) {
    const Vec step = damped_step(J, r, D, mu);
    ++report.evaluations.linear_solve;
    const Vec trial = solution.z + step;
    const bool is_finite = problem.evaluate(trial, trial_r, nullptr);
    ++report.evaluations.value;
    const double trial_cost = is_finite ? 0.5 * trial_r.squaredNorm() : HUGE_VAL;
    const double predicted = 0.5 * (r.squaredNorm() - (r + J * step).squaredNorm());
    const double gain = (solution.cost - trial_cost) / predicted;
    const bool is_tiny = (step.array().abs() <= 1e-16 * solution.z.array().abs()).all();
    if (trial_cost < solution.cost) {
      const double decrease = 1 - trial_cost / solution.cost;
      solution.z = trial;
      solution.cost = trial_cost;
      report.trace.push_back(
          {k, trial_cost, 0, 0, step.norm(), std::chrono::duration<double>(Clock::now() - begin).count()});
      problem.evaluate(trial, r, &J);
      ++report.evaluations.jacobian;
      update_scales(J, D);
      mu *= std::max(1.0 / 3, 1 - std::pow(2 * gain - 1, 3));  // Nielsen 1999
      growth = 2;
      if (decrease < options.tolerance && predicted < options.tolerance * solution.cost && mu < 1) break;
    } else {
      if (is_tiny || predicted < options.tolerance * solution.cost || mu > 1e20) break;
      mu *= growth;
      growth *= 2;
    }
  }
  report.termination = k < options.max_iterations ? Termination::Converged : Termination::IterationLimit;
  report.message = fmt::format("{} iterations", k + 1);
  judge(problem, solution);
  return solution;
}

}  // namespace softform
