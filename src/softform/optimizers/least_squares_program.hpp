#pragma once

#include "softform/optimizers/nonlinear_program.hpp"

namespace softform {

/// min 1/2 |r(z)|^2 within bounds: a programme that shows its residuals, for methods that live on them.
class LeastSquaresProgram : public NonlinearProgram {
 public:
  virtual int residual_count() const = 0;
  virtual void residuals(ConstVec z, Vec& r) const = 0;
  /// (residual_count, variable_count), the same pattern at every call.
  virtual void residual_jacobian(ConstVec z, SparseMatrix& R) const = 0;

  double objective(ConstVec z) const override;
  void objective_gradient(ConstVec z, Vec& g) const override;
  void gauss_newton_hessian(ConstVec z, SparseMatrix& H) const override;
  int constraint_count() const override { return 0; }
  void constraints(ConstVec, Vec& c) const override { c.resize(0); }
  void constraint_jacobian(ConstVec, SparseMatrix& J) const override { J.resize(0, variable_count()); }
};

}  // namespace softform
