#include "softform/optimizers/nonlinear_program.hpp"

namespace softform {

void NonlinearProgram::step_metric(ConstVec, SparseMatrix& D) const
{
  D.resize(variable_count(), variable_count());
  D.setIdentity();
}

}  // namespace softform
