#include "softform/optimizers/least_squares_program.hpp"

namespace softform {

double LeastSquaresProgram::objective(ConstVec z) const
{
  Vec r;
  residuals(z, r);
  return 0.5 * r.squaredNorm();
}

void LeastSquaresProgram::objective_gradient(ConstVec z, Vec& g) const
{
  Vec r;
  SparseMatrix R;
  residuals(z, r);
  residual_jacobian(z, R);
  g = R.transpose() * r;
}

void LeastSquaresProgram::gauss_newton_hessian(ConstVec z, SparseMatrix& H) const
{
  SparseMatrix R;
  residual_jacobian(z, R);
  H = SparseMatrix(R.transpose()) * R;
}

}  // namespace softform
