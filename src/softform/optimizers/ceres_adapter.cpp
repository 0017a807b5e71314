#include "softform/optimizers/ceres_adapter.hpp"

#include <ceres/ceres.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "softform/core/error.hpp"
#include "softform/optimizers/least_squares_program.hpp"
#include "softform/optimizers/monitor.hpp"
#include "softform/optimizers/optimality.hpp"

namespace softform {
namespace {

class Residuals : public ceres::CostFunction {
 public:
  Residuals(const LeastSquaresProgram& program, Evaluations& count) : program_(program), count_(count)
  {
    set_num_residuals(program.residual_count());
    mutable_parameter_block_sizes()->push_back(program.variable_count());
  }

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override
  {
    using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    const Eigen::Map<const Vec> z(parameters[0], program_.variable_count());
    Vec r;
    program_.residuals(z, r);
    ++count_.value;
    Eigen::Map<Vec>(residuals, r.size()) = r;
    if (jacobians == nullptr || jacobians[0] == nullptr) return r.allFinite();
    SparseMatrix R;
    program_.residual_jacobian(z, R);
    ++count_.jacobian;
    Eigen::Map<RowMajor>(jacobians[0], R.rows(), R.cols()) = RowMajor(R);
    return r.allFinite() && R.coeffs().allFinite();
  }

 private:
  const LeastSquaresProgram& program_;
  Evaluations& count_;
};

class Watch : public ceres::IterationCallback {
 public:
  explicit Watch(Monitor& monitor) : monitor_(monitor) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary& it) override
  {
    was_stopped = monitor_.record({count_++, it.cost, it.gradient_max_norm, 0, it.step_norm, 0});
    return was_stopped ? ceres::SOLVER_TERMINATE_SUCCESSFULLY : ceres::SOLVER_CONTINUE;
  }
  bool was_stopped = false;

 private:
  Monitor& monitor_;
  int count_ = 0;
};

/// The variables that the gradient presses against a bound.
std::vector<int> pressed(const LeastSquaresProgram& program, const Vec& z)
{
  const Vec lower = program.lower_bounds(), upper = program.upper_bounds();
  Vec g;
  program.objective_gradient(z, g);
  std::vector<int> found;
  for (int i = 0; i < z.size(); ++i)
    if ((z[i] <= lower[i] && g[i] > 0) || (z[i] >= upper[i] && g[i] < 0)) found.push_back(i);
  return found;
}

ceres::Solver::Summary solve(const LeastSquaresProgram& program, const std::vector<int>& held,
                             const ceres::Solver::Options& settings, Evaluations& count, Vec& z)
{
  ceres::Problem problem;
  problem.AddResidualBlock(new Residuals(program, count), nullptr, z.data());
  const Vec lower = program.lower_bounds(), upper = program.upper_bounds();
  for (int i = 0; i < z.size(); ++i) {
    if (std::isfinite(lower[i])) problem.SetParameterLowerBound(z.data(), i, lower[i]);
    if (std::isfinite(upper[i])) problem.SetParameterUpperBound(z.data(), i, upper[i]);
  }
  if (!held.empty()) problem.SetManifold(z.data(), new ceres::SubsetManifold(static_cast<int>(z.size()), held));
  ceres::Solver::Summary summary;
  ceres::Solve(settings, &problem, &summary);
  count.linear_solve += summary.num_linear_solves;
  return summary;
}

Termination termination_of(const ceres::Solver::Summary& summary)
{
  switch (summary.termination_type) {
    case ceres::CONVERGENCE: return Termination::Converged;
    case ceres::NO_CONVERGENCE: return Termination::IterationLimit;
    default: return Termination::NotFinite;
  }
}

ceres::Solver::Options make_settings(const CeresOptions& options, const StopCriteria& stop, Watch& watch)
{
  ceres::Solver::Options settings;
  settings.linear_solver_type = ceres::DENSE_QR;
  settings.max_num_iterations = stop.max_iterations;
  settings.max_solver_time_in_seconds = std::max(0.0, stop.max_time_s);
  settings.function_tolerance = options.function_tolerance;
  settings.gradient_tolerance = stop.tolerance;
  settings.parameter_tolerance = options.parameter_tolerance;
  settings.logging_type = ceres::SILENT;
  settings.callbacks.push_back(&watch);
  return settings;
}

}  // namespace

Solution CeresAdapter::minimize(const NonlinearProgram& program, const StopCriteria& stop,
                                const IterationObserver& observer) const
{
  require(program, "ceres", false, true);
  const auto* least_squares = dynamic_cast<const LeastSquaresProgram*>(&program);
  if (least_squares == nullptr)
    throw InputError(fmt::format("{}: ceres needs the residuals of a LeastSquaresProgram", program.name()));

  Solution solution;
  Report& report = solution.report;
  Vec& z = solution.z = program.initial_point().cwiseMax(program.lower_bounds()).cwiseMin(program.upper_bounds());
  Monitor monitor(stop, observer, report);
  Watch watch(monitor);
  const ceres::Solver::Options settings = make_settings(options_, stop, watch);
  const auto n = static_cast<std::size_t>(z.size());
  std::vector<int> held;
  for (std::size_t round = 0; round <= 2 * n; ++round) {
    const ceres::Solver::Summary summary = solve(*least_squares, held, settings, report.evaluations, z);
    if (watch.was_stopped) break;
    monitor.finish(termination_of(summary), "Ceres: " + summary.message);
    std::vector<int> next = pressed(*least_squares, z);
    if (!report.converged() || next == held || next.size() == n) break;
    held = std::move(next);
  }
  judge(program, {.stationarity = watch.was_stopped ? HUGE_VAL : Tolerances{}.stationarity}, solution);
  return solution;
}

}  // namespace softform
