#pragma once

#include <optional>
#include <string>

#include "softform/core/types.hpp"

namespace softform {

/// A nonlinear programme  min f(z)  subject to  c(z) = 0,  lower <= z <= upper:  all that an optimiser sees. It knows
/// no elasticity. The Lagrangian is L = f + lambda . c, so that at an optimum  f' + J^t lambda = bound_multipliers. The
/// functions are pure; objects keep scratch memory, so that one object serves one thread.
class NonlinearProgram {
 public:
  virtual ~NonlinearProgram() = default;

  virtual std::string name() const = 0;
  virtual int variable_count() const = 0;
  virtual int constraint_count() const = 0;
  virtual Vec initial_point() const = 0;
  /// Bounds (variable_count), +-infinity where there is none; none at all unless the programme says otherwise.
  virtual Vec lower_bounds() const;
  virtual Vec upper_bounds() const;

  virtual double objective(ConstVec z) const = 0;
  virtual void objective_gradient(ConstVec z, Vec& g) const = 0;
  /// A positive semi-definite model of the objective's Hessian, both triangles stored, the same pattern at every call.
  virtual void gauss_newton_hessian(ConstVec z, SparseMatrix& H) const = 0;

  virtual void constraints(ConstVec z, Vec& c) const = 0;
  /// (constraint_count, variable_count), the same pattern at every call.
  virtual void constraint_jacobian(ConstVec z, SparseMatrix& J) const = 0;

  /// The exact Hessian of f + lambda . c, both triangles stored, the same pattern at every call. Returns false, and
  /// leaves H alone, when the programme has none.
  virtual bool lagrangian_hessian(ConstVec z, ConstVec lambda, SparseMatrix& H) const;

  /// U (variable_count, k): a part U U^t of the objective's Hessian that would fill it, and is left out of the two
  /// above.
  virtual Eigen::MatrixXd dense_curvature(ConstVec) const { return Eigen::MatrixXd(variable_count(), 0); }

  /// Multipliers lambda at a feasible point for which the Lagrangian is stationary in the state that the constraints
  /// define: those of the adjoint method, which make f' + J^t lambda the gradient of the objective as a function of the
  /// design alone. Nothing where the constraints define no state.
  virtual std::optional<Vec> adjoint_multipliers(ConstVec) const { return std::nullopt; }

  /// A positive semi-definite metric in which steps are measured; the identity unless the problem knows better.
  virtual void step_metric(ConstVec z, SparseMatrix& D) const;

  /// A feasible point near z, found by solving c = 0 for the state at the design of z; nothing when there is none.
  /// Programmes whose constraints define no state have none either.
  virtual std::optional<Vec> restore(ConstVec) const { return std::nullopt; }

  /// Sparse factorisations made inside these functions so far, by equilibria and adjoints: part of what a method costs.
  virtual int inner_linear_solves() const { return 0; }
};

}  // namespace softform
