#pragma once

#include "softform/optimizers/nonlinear_program.hpp"
#include "softform/optimizers/normal_matrix.hpp"

namespace softform {

/// The second derivatives that a Newton step is made of.
enum class HessianModel {
  Exact,        ///< that of the Lagrangian, where the programme has one, else Gauss-Newton
  GaussNewton,  ///< the objective's semi-definite model, with the constraints linearised
};

/// A point and what the augmented function is there.
struct AugmentedPoint {
  Vec z;
  double objective = 0;  ///< f
  Vec constraints;       ///< c
  double value = 0;      ///< phi
  Vec gradient;          ///< of phi
  double slope = 0;      ///< largest entry of the gradient of f

  double infeasibility() const { return constraints.size() > 0 ? constraints.cwiseAbs().maxCoeff() : 0; }
};

/// phi(z) = f(z) + lambda . c(z) + mu/2 |c(z)|^2: the functions of (3.40), lambda = 0, and (3.52), whose lambda has the
/// other sign; f alone where there are no constraints.
class AugmentedFunction {
 public:
  AugmentedFunction(const NonlinearProgram& program, HessianModel model);

  Vec multipliers;     ///< lambda, (constraint_count), zero at first
  double penalty = 0;  ///< mu

  /// f, c and phi at z, without the gradient.
  AugmentedPoint evaluate(ConstVec z) const;
  /// Adds the gradient. Returns false when one of its parts is not finite.
  bool differentiate(AugmentedPoint& point);
  /// Evaluates the model's matrices, after differentiate at the same point. Returns false when one is not finite.
  bool linearize(const AugmentedPoint& point);
  /// H + mu J^t J + alpha M at the last linearisation, lower triangle; M is the programme's metric, with a little of
  /// the identity where that measures nothing.
  const SparseMatrix& model(double alpha);

  /// lambda + mu c: what the gradient of phi takes for the multipliers (3.53).
  Vec estimated_multipliers(const AugmentedPoint& point) const { return multipliers + penalty * point.constraints; }
  /// max diag H / max diag J^t J at z, H the Gauss-Newton Hessian of f: the penalty at which the constraints weigh as
  /// much as the objective, whatever the units of either. 1 where one of them is zero.
  double balanced_penalty(ConstVec z) const;

  /// J^t c / max(1, |J|), largest norm: zero where |c|^2 is stationary.
  Vec infeasibility_gradient(const AugmentedPoint& point);

 private:
  const NonlinearProgram& program_;
  HessianModel model_;
  bool is_exact_ = false;
  SparseMatrix H_, J_, D_;
  NormalMatrix normal_;
};

}  // namespace softform
