#include "softform/optimizers/nonlinear_program.hpp"

#include <limits>

namespace softform {

Vec NonlinearProgram::lower_bounds() const
{
  return Vec::Constant(variable_count(), -std::numeric_limits<double>::infinity());
}

Vec NonlinearProgram::upper_bounds() const
{
  return Vec::Constant(variable_count(), std::numeric_limits<double>::infinity());
}

bool NonlinearProgram::lagrangian_hessian(ConstVec, ConstVec, SparseMatrix&) const { return false; }

void NonlinearProgram::step_metric(ConstVec, SparseMatrix& D) const
{
  D.resize(variable_count(), variable_count());
  D.setIdentity();
}

}  // namespace softform
