#include "softform/optimizers/ceres_adapter.hpp"

#include <ceres/ceres.h>

#include <cmath>

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
    was_stopped = monitor_.record({it.iteration, it.cost, it.gradient_max_norm, 0, it.step_norm, 0});
    return was_stopped ? ceres::SOLVER_TERMINATE_SUCCESSFULLY : ceres::SOLVER_CONTINUE;
  }
  bool was_stopped = false;

 private:
  Monitor& monitor_;
};

void set_bounds(const LeastSquaresProgram& program, Vec& z, ceres::Problem& problem)
{
  const Vec lower = program.lower_bounds(), upper = program.upper_bounds();
  z = z.cwiseMax(lower).cwiseMin(upper);
  for (int i = 0; i < z.size(); ++i) {
    if (std::isfinite(lower[i])) problem.SetParameterLowerBound(z.data(), i, lower[i]);
    if (std::isfinite(upper[i])) problem.SetParameterUpperBound(z.data(), i, upper[i]);
  }
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
  solution.z = program.initial_point();
  ceres::Problem problem;
  problem.AddResidualBlock(new Residuals(*least_squares, report.evaluations), nullptr, solution.z.data());
  set_bounds(*least_squares, solution.z, problem);
  Monitor monitor(stop, observer, report);
  Watch watch(monitor);
  ceres::Solver::Options settings;
  settings.linear_solver_type = ceres::DENSE_QR;
  settings.max_num_iterations = stop.max_iterations;
  settings.max_solver_time_in_seconds = std::max(0.0, stop.max_time_s);
  settings.function_tolerance = options_.function_tolerance;
  settings.gradient_tolerance = options_.gradient_tolerance;
  settings.parameter_tolerance = options_.parameter_tolerance;
  settings.logging_type = ceres::SILENT;
  settings.callbacks.push_back(&watch);
  ceres::Solver::Summary summary;
  ceres::Solve(settings, &problem, &summary);

  report.evaluations.linear_solve = summary.num_linear_solves;
  if (!watch.was_stopped) {
    const bool is_over = summary.termination_type == ceres::NO_CONVERGENCE;
    monitor.finish(summary.termination_type == ceres::CONVERGENCE ? Termination::Converged
                   : is_over                                      ? Termination::IterationLimit
                                                                  : Termination::NotFinite,
                   "Ceres: " + summary.message);
  }
  const double stationarity = watch.was_stopped ? HUGE_VAL : Tolerances{}.stationarity;
  judge(program, {.stationarity = stationarity}, solution);
  return solution;
}

}  // namespace softform
