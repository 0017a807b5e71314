// Everything that needs Ceres' headers.
#include <Eigen/SVD>
#include <ceres/ceres.h>
#include <fmt/format.h>

#include "softform/fitting/least_squares.hpp"

namespace softform {
namespace {

/// Relative to the largest: below, rounding decides what the covariance is.
constexpr double smallest_singular_value = 1e-12;

class CostFunction : public ceres::CostFunction {
 public:
  explicit CostFunction(const LeastSquaresProblem& problem) : problem_(problem)
  {
    set_num_residuals(problem.residual_count());
    mutable_parameter_block_sizes()->push_back(problem.parameter_count());
  }

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override
  {
    const Eigen::Map<const Vec> z(parameters[0], problem_.parameter_count());
    const bool wants_jacobian = jacobians != nullptr && jacobians[0] != nullptr;
    Vec r;
    Eigen::MatrixXd J;
    if (!problem_.evaluate(z, r, wants_jacobian ? &J : nullptr)) return false;
    Eigen::Map<Vec>(residuals, r.size()) = r;
    using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    if (wants_jacobian) Eigen::Map<RowMajor>(jacobians[0], J.rows(), J.cols()) = J;
    return true;
  }

 private:
  const LeastSquaresProblem& problem_;
};

Termination termination_of(const ceres::Solver::Summary& summary)
{
  switch (summary.termination_type) {
    case ceres::CONVERGENCE: return Termination::Converged;
    case ceres::NO_CONVERGENCE: return Termination::IterationLimit;
    case ceres::USER_SUCCESS:
    case ceres::USER_FAILURE: return Termination::Interrupted;
    case ceres::FAILURE: break;
  }
  return Termination::NotFinite;
}

}  // namespace

LeastSquaresSolution minimize_by_ceres(const LeastSquaresProblem& problem, ConstVec start,
                                       const LeastSquaresOptions& options)
{
  LeastSquaresSolution solution;
  solution.z = start;
  ceres::Problem ceres_problem;
  ceres_problem.AddResidualBlock(new CostFunction(problem), nullptr, solution.z.data());
  ceres::Solver::Options settings;
  settings.linear_solver_type = ceres::DENSE_QR;
  settings.max_num_iterations = options.max_iterations;
  settings.function_tolerance = options.tolerance;
  settings.gradient_tolerance = 1e-30;  // has the problem's units: the relative criteria decide
  settings.parameter_tolerance = 1e-15;
  settings.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(settings, &ceres_problem, &summary);

  solution.cost = summary.final_cost;
  solution.report.termination = termination_of(summary);
  for (const auto& it : summary.iterations)
    solution.report.trace.push_back(
        {it.iteration, it.cost, it.gradient_max_norm, 0, it.step_norm, it.cumulative_time_in_seconds});
  solution.report.evaluations.value = summary.num_residual_evaluations;
  solution.report.evaluations.jacobian = summary.num_jacobian_evaluations;
  solution.report.evaluations.linear_solve = summary.num_linear_solves;
  solution.report.message = fmt::format("{} iterations", summary.iterations.size());
  judge(problem, solution);
  return solution;
}

std::optional<Eigen::MatrixXd> inverse_normal_matrix(const LeastSquaresProblem& problem, ConstVec z)
{
  const int n = problem.parameter_count();
  Vec point = z, residuals;
  Eigen::MatrixXd J;
  if (!problem.evaluate(z, residuals, &J)) return std::nullopt;
  const Vec singular_values = Eigen::JacobiSVD<Eigen::MatrixXd>(J).singularValues();
  if (!(singular_values[n - 1] > smallest_singular_value * singular_values[0])) return std::nullopt;

  ceres::Problem ceres_problem;
  ceres_problem.AddResidualBlock(new CostFunction(problem), nullptr, point.data());
  ceres::Covariance::Options settings;
  settings.algorithm_type = ceres::DENSE_SVD;
  settings.min_reciprocal_condition_number = 1e-30;  // of J^T J; decided above
  ceres::Covariance covariance(settings);
  const double* block = point.data();
  if (!covariance.Compute(std::vector<const double*>{block}, &ceres_problem)) return std::nullopt;
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> inverse(n, n);
  covariance.GetCovarianceBlock(block, block, inverse.data());
  return Eigen::MatrixXd(inverse);
}

}  // namespace softform
