#pragma once

#include "softform/core/report.hpp"
#include "softform/optimizers/nonlinear_program.hpp"

namespace softform {

/// Another programme that counts what is evaluated, and the factorisations made for it inside: what a method costs,
/// whoever wrote it.
class CountedProgram : public NonlinearProgram {
 public:
  /// Both outlive this object.
  CountedProgram(const NonlinearProgram& program, Evaluations& count)
      : program_(program), count_(count), seen_(program.inner_linear_solves())
  {}

  std::string name() const override { return program_.name(); }
  int variable_count() const override { return program_.variable_count(); }
  int constraint_count() const override { return program_.constraint_count(); }
  Vec initial_point() const override { return program_.initial_point(); }
  Vec lower_bounds() const override { return program_.lower_bounds(); }
  Vec upper_bounds() const override { return program_.upper_bounds(); }

  double objective(ConstVec z) const override;
  void objective_gradient(ConstVec z, Vec& g) const override;
  void gauss_newton_hessian(ConstVec z, SparseMatrix& H) const override;
  void constraints(ConstVec z, Vec& c) const override;
  void constraint_jacobian(ConstVec z, SparseMatrix& J) const override;
  bool lagrangian_hessian(ConstVec z, ConstVec lambda, SparseMatrix& H) const override;
  Eigen::MatrixXd dense_curvature(ConstVec z) const override;
  void step_metric(ConstVec z, SparseMatrix& D) const override;
  std::optional<Vec> adjoint_multipliers(ConstVec z) const override;
  std::optional<Vec> restore(ConstVec z) const override;
  int inner_linear_solves() const override { return program_.inner_linear_solves(); }

 private:
  void count_inner() const;

  const NonlinearProgram& program_;
  Evaluations& count_;
  mutable int seen_;  // inner factorisations that are counted already
};

}  // namespace softform
