#pragma once

#include "softform/core/types.hpp"
#include "softform/linalg/symmetric_indefinite.hpp"

namespace softform {

/// The symmetric KKT system  [W, J^t; J, 0] (d, delta) = -(a, c)  of n variables and m constraints, solved to a
/// tolerance. What is factorised has -e I for the zero block, which heals dependent rows of J and fixes the inertia;
/// refinement against the true system then takes the effect of e away wherever the constraints allow it.
class KktSystem {
 public:
  /// e in units of max|J|^2 / max|W|.
  explicit KktSystem(double constraint_regularization = 1e-8) : regularization_(constraint_regularization) {}

  /// W symmetric (n, n), both triangles stored, J (m, n). Returns false when the matrix is singular or not finite.
  bool factorize(const SparseMatrix& W, const SparseMatrix& J);

  int constraint_count() const { return static_cast<int>(J_.rows()); }
  /// True when W is positive definite where J d = 0: the matrix then has exactly m negative eigenvalues.
  bool is_convex() const { return factorization_.negative_eigenvalues() == J_.rows(); }
  int negative_eigenvalues() const { return factorization_.negative_eigenvalues(); }

  struct Step {
    Vec d, delta;
    Vec rho, r;                ///< residuals: W d + J^t delta + a  and  J d + c
    double relative_residual;  ///< |(rho, r)| / |(a, c)|
    int solves;
  };
  /// Refines until the relative residual is below the tolerance or falls no more.
  Step solve(ConstVec a, ConstVec c, double tolerance) const;

 private:
  double regularization_;
  SparseMatrix W_, J_;
  SymmetricIndefinite factorization_;
};

/// The multipliers that minimise |g + J^t lambda|.
Vec least_squares_multipliers(ConstVec g, const SparseMatrix& J);

}  // namespace softform
