#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "softform/core/report.hpp"
#include "softform/core/types.hpp"

namespace softform {

/// min 1/2 |r(z)|^2 over z in R^n, with r in R^m. The solvers see nothing else: no material, no data.
class LeastSquaresProblem {
 public:
  virtual ~LeastSquaresProblem() = default;

  virtual int parameter_count() const = 0;
  virtual int residual_count() const = 0;

  /// Writes r(z) and, where a Jacobian is asked for, dr/dz (m, n). Returns false where they are not finite: solvers
  /// step there and come back.
  virtual bool evaluate(ConstVec z, Vec& residuals, Eigen::MatrixXd* jacobian) const = 0;

  /// How much of z_j counts as a large step (n): what methods without derivatives try first.
  virtual Vec scale(ConstVec z) const { return (z.array() == 0).select(1, z.cwiseAbs()); }
};

struct LeastSquaresOptions {
  int max_iterations = 3000;  ///< of one start; NIST's hardest problems need some hundred
  double tolerance = 1e-15;   ///< relative decrease of the cost below which a step is the last: round-off
};

struct LeastSquaresSolution {
  Vec z;
  double cost = 0;  ///< 1/2 |r|^2
  /// The largest cosine between r and a column of the Jacobian: 0 at a minimum, whatever the scales. See stationarity.
  double stationarity = 0;
  Report report;
};

/// A method of least squares, known by name.
struct LeastSquaresSolver {
  std::string name;
  LeastSquaresSolution (*minimize)(const LeastSquaresProblem&, ConstVec start, const LeastSquaresOptions&);
  /// A global search of a box for a point to start from; null where the method has none.
  Vec (*search)(const LeastSquaresProblem&, ConstVec lower, ConstVec upper, unsigned seed);
};

/// ceres (Levenberg-Marquardt of Ceres), nlopt (derivative-free: Sbplx and Bobyqa from a start, CRS2 to search a box),
/// gauss_newton (the project's own, with Levenberg and Marquardt's damping).
const std::vector<LeastSquaresSolver>& least_squares_solvers();

/// Throws InputError listing the known names.
const LeastSquaresSolver& find_least_squares_solver(const std::string& name);

/// max_j |J_j . r| / (|J_j| |r|), with zero where r or a column is zero; infinity where r is not finite.
double stationarity(const LeastSquaresProblem& problem, ConstVec z);

/// Fills in the stationarity, and says Stalled for a solver that stopped where the residuals are not stationary.
void judge(const LeastSquaresProblem& problem, LeastSquaresSolution& solution);

/// (J^T J)^-1 at z (n, n) by Ceres' dense SVD; nothing where J is rank-deficient to round-off.
std::optional<Eigen::MatrixXd> inverse_normal_matrix(const LeastSquaresProblem& problem, ConstVec z);

/// The project's own solver: Gauss-Newton with Levenberg and Marquardt's damping.
LeastSquaresSolution minimize_by_gauss_newton(const LeastSquaresProblem& problem, ConstVec start,
                                              const LeastSquaresOptions& options);
LeastSquaresSolution minimize_by_ceres(const LeastSquaresProblem& problem, ConstVec start,
                                       const LeastSquaresOptions& options);
LeastSquaresSolution minimize_by_nlopt(const LeastSquaresProblem& problem, ConstVec start,
                                       const LeastSquaresOptions& options);
Vec search_by_nlopt(const LeastSquaresProblem& problem, ConstVec lower, ConstVec upper, unsigned seed);

}  // namespace softform
