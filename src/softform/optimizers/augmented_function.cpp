#include "softform/optimizers/augmented_function.hpp"

#include <algorithm>
#include <cmath>

namespace softform {

AugmentedFunction::AugmentedFunction(const NonlinearProgram& program, HessianModel model)
    : multipliers(Vec::Zero(program.constraint_count())),
      program_(program),
      model_(model),
      J_(program.constraint_count(), program.variable_count())
{}

AugmentedPoint AugmentedFunction::evaluate(ConstVec z) const
{
  AugmentedPoint point{z, program_.objective(z), Vec(0), 0, Vec(0), 0};
  if (multipliers.size() > 0) program_.constraints(z, point.constraints);
  point.value = point.objective + multipliers.dot(point.constraints) + 0.5 * penalty * point.constraints.squaredNorm();
  return point;
}

bool AugmentedFunction::differentiate(AugmentedPoint& point)
{
  program_.objective_gradient(point.z, point.gradient);
  point.slope = point.gradient.cwiseAbs().maxCoeff();
  if (multipliers.size() > 0) {
    program_.constraint_jacobian(point.z, J_);
    point.gradient += J_.transpose() * estimated_multipliers(point);
  }
  return point.gradient.allFinite() && J_.coeffs().allFinite();
}

bool AugmentedFunction::linearize(const AugmentedPoint& point)
{
  is_exact_ = model_ == HessianModel::Exact && program_.lagrangian_hessian(point.z, estimated_multipliers(point), H_);
  if (!is_exact_) program_.gauss_newton_hessian(point.z, H_);
  program_.step_metric(point.z, D_);
  return normal_.assemble(H_, J_, penalty, D_, 0).coeffs().allFinite();
}

const SparseMatrix& AugmentedFunction::model(double alpha)
{
  // The metric of a design says nothing about the state, where an exact Hessian may be indefinite too; a semi-definite
  // model only needs the rigid motions held.
  const double share_of_identity = is_exact_ ? 1e-3 : 1e-8;
  return normal_.with_damping(D_, alpha, alpha * share_of_identity * D_.diagonal().mean());
}

double AugmentedFunction::balanced_penalty(ConstVec z) const
{
  if (multipliers.size() == 0) return 1;
  SparseMatrix H, J;
  program_.gauss_newton_hessian(z, H);
  program_.constraint_jacobian(z, J);
  const double objective = H.diagonal().maxCoeff();
  double constraints = 0;
  for (int j = 0; j < J.outerSize(); ++j) constraints = std::max(constraints, J.col(j).squaredNorm());
  const double balanced = objective / constraints;
  return balanced > 0 && std::isfinite(balanced) ? balanced : 1;
}

Vec AugmentedFunction::infeasibility_gradient(const AugmentedPoint& point)
{
  program_.constraint_jacobian(point.z, J_);
  return J_.transpose() * point.constraints / std::max(1.0, J_.coeffs().abs().maxCoeff());
}

}  // namespace softform
