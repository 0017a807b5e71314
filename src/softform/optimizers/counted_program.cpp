#include "softform/optimizers/counted_program.hpp"

namespace softform {

double CountedProgram::objective(ConstVec z) const
{
  ++count_.value;
  return program_.objective(z);
}

void CountedProgram::objective_gradient(ConstVec z, Vec& g) const
{
  ++count_.gradient;
  program_.objective_gradient(z, g);
}

void CountedProgram::gauss_newton_hessian(ConstVec z, SparseMatrix& H) const
{
  ++count_.hessian;
  program_.gauss_newton_hessian(z, H);
}

void CountedProgram::constraints(ConstVec z, Vec& c) const
{
  ++count_.constraint;
  program_.constraints(z, c);
}

void CountedProgram::constraint_jacobian(ConstVec z, SparseMatrix& J) const
{
  ++count_.jacobian;
  program_.constraint_jacobian(z, J);
}

bool CountedProgram::lagrangian_hessian(ConstVec z, ConstVec lambda, SparseMatrix& H) const
{
  const bool has_one = program_.lagrangian_hessian(z, lambda, H);
  count_.hessian += has_one;
  return has_one;
}

}  // namespace softform
