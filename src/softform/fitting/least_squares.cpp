#include "softform/fitting/least_squares.hpp"

#include <limits>

#include <fmt/format.h>

#include "softform/core/error.hpp"

namespace softform {

const std::vector<LeastSquaresSolver>& least_squares_solvers()
{
  static const std::vector<LeastSquaresSolver> solvers{
      {"ceres", minimize_by_ceres, nullptr},
      {"nlopt", minimize_by_nlopt, search_by_nlopt},
      {"gauss_newton", minimize_by_gauss_newton, nullptr},
  };
  return solvers;
}

const LeastSquaresSolver& find_least_squares_solver(const std::string& name)
{
  std::string known;
  for (const LeastSquaresSolver& solver : least_squares_solvers()) {
    if (solver.name == name) return solver;
    known += (known.empty() ? "" : ", ") + solver.name;
  }
  throw InputError(fmt::format("unknown solver '{}': use one of {}", name, known));
}

double stationarity(const LeastSquaresProblem& problem, ConstVec z)
{
  Vec residuals;
  Eigen::MatrixXd jacobian;
  if (!problem.evaluate(z, residuals, &jacobian)) return std::numeric_limits<double>::infinity();
  const double size = residuals.norm();
  double largest = 0;
  for (const auto& column : jacobian.colwise()) {
    const double scale = column.norm() * size;
    if (scale > 0) largest = std::max(largest, std::abs(column.dot(residuals)) / scale);
  }
  return largest;
}

void judge(const LeastSquaresProblem& problem, LeastSquaresSolution& solution)
{
  constexpr double largest_cosine = 1e-4;  // solvers without derivatives end near 1e-7
  solution.stationarity = stationarity(problem, solution.z);
  Report& report = solution.report;
  if (report.converged() && !(solution.stationarity <= largest_cosine)) report.termination = Termination::Stalled;
  report.message += fmt::format(", stationarity {:.1e}", solution.stationarity);
}

}  // namespace softform
