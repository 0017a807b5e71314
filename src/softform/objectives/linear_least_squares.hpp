#pragma once

#include <utility>

#include "softform/objectives/objective.hpp"

namespace softform {

/// |A x - b|^2: objectives whose residuals are linear in the positions.
class LinearLeastSquares : public Objective {
 public:
  /// A (k, n), b (k).
  LinearLeastSquares(const SparseMatrix& A, Vec b) : A_(A), b_(std::move(b)), hessian_(2 * (A_.transpose() * A_)) {}

  double value(ConstVec x) const override { return (A_ * x - b_).squaredNorm(); }
  void gradient(ConstVec x, Vec& g) const override { g = 2 * (A_.transpose() * (A_ * x - b_)); }
  void gauss_newton_hessian(ConstVec, SparseMatrix& H) const override { H = hessian_; }
  bool hessian(ConstVec, SparseMatrix& H) const override
  {
    H = hessian_;
    return true;
  }

 private:
  SparseMatrix A_;
  Vec b_;
  SparseMatrix hessian_;
};

}  // namespace softform
