#include "softform/optimizers/counted_program.hpp"

namespace softform {

void CountedProgram::count_inner() const
{
  const int now = program_.inner_linear_solves();
  count_.linear_solve += now - seen_;
  seen_ = now;
}

double CountedProgram::objective(ConstVec z) const
{
  ++count_.value;
  const double value = program_.objective(z);
  count_inner();
  return value;
}

void CountedProgram::objective_gradient(ConstVec z, Vec& g) const
{
  ++count_.gradient;
  program_.objective_gradient(z, g);
  count_inner();
}

void CountedProgram::gauss_newton_hessian(ConstVec z, SparseMatrix& H) const
{
  ++count_.hessian;
  program_.gauss_newton_hessian(z, H);
  count_inner();
}

void CountedProgram::constraints(ConstVec z, Vec& c) const
{
  ++count_.constraint;
  program_.constraints(z, c);
  count_inner();
}

void CountedProgram::constraint_jacobian(ConstVec z, SparseMatrix& J) const
{
  ++count_.jacobian;
  program_.constraint_jacobian(z, J);
  count_inner();
}

bool CountedProgram::lagrangian_hessian(ConstVec z, ConstVec lambda, SparseMatrix& H) const
{
  const bool has_one = program_.lagrangian_hessian(z, lambda, H);
  count_.hessian += has_one;
  count_inner();
  return has_one;
}

Eigen::MatrixXd CountedProgram::dense_curvature(ConstVec z) const
{
  Eigen::MatrixXd factors = program_.dense_curvature(z);
  count_inner();
  return factors;
}

std::optional<Vec> CountedProgram::adjoint_multipliers(ConstVec z) const
{
  std::optional<Vec> lambda = program_.adjoint_multipliers(z);
  count_inner();
  return lambda;
}

void CountedProgram::step_metric(ConstVec z, SparseMatrix& D) const
{
  program_.step_metric(z, D);
  count_inner();
}

std::optional<Vec> CountedProgram::restore(ConstVec z) const
{
  std::optional<Vec> restored = program_.restore(z);
  count_inner();
  return restored;
}

}  // namespace softform
