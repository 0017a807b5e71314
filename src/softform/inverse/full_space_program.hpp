#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "softform/equilibrium/potential.hpp"
#include "softform/inverse/coupled_objective.hpp"
#include "softform/linalg/sparse_sum.hpp"
#include "softform/objectives/weighted_sum.hpp"
#include "softform/optimizers/nonlinear_program.hpp"

namespace softform {

/// What a state x has to be at a design p: in equilibrium, f(x, p) = 0 (3.39), with as many forces as coordinates.
class EquilibriumConstraint {
 public:
  virtual ~EquilibriumConstraint() = default;

  /// f, dimensionless.
  virtual void forces(ConstVec x, ConstVec p, Vec& f) = 0;
  /// df/dx, symmetric, and df/dp: on patterns that stay.
  virtual void state_jacobian(ConstVec x, ConstVec p, SparseMatrix& K) = 0;
  virtual void design_jacobian(ConstVec x, ConstVec p, SparseMatrix& B) = 0;
  /// The Hessian of lambda . f in its blocks (x, x), (x, p) and (p, p).
  virtual void force_hessian(ConstVec x, ConstVec p, ConstVec lambda, SparseMatrix& xx, SparseMatrix& mixed,
                             SparseMatrix& pp) = 0;
  /// (df/dx)^-1 b at a stable equilibrium, without what b has in rigid motions, which the forces do not resist.
  virtual Vec solve_state(ConstVec x, ConstVec p, const Vec& b) = 0;
  /// A stable equilibrium at p, sought from x, or nothing.
  virtual std::optional<Vec> equilibrium(ConstVec x, ConstVec p) = 0;
  /// Factorisations made in equilibrium() and solve_state() so far.
  virtual int linear_solves() const = 0;
};

/// An inverse problem (3.39): the design p for which the equilibrium x(p) minimises
///     sum_k w_k E_k(x) + sum_l v_l R_l(p) + S(x, p)   subject to   f(x, p) = 0.
struct InverseDesign {
  std::shared_ptr<EquilibriumConstraint> constraint;
  Vec x0, p0;                                                ///< a state near equilibrium and the first design
  std::vector<WeightedObjective> state_terms;                ///< E_k(x)
  std::vector<WeightedObjective> design_terms;               ///< R_l(p)
  std::shared_ptr<CoupledObjective> coupled_term = nullptr;  ///< S(x, p), or none
  std::function<void(ConstVec p, SparseMatrix& D)> metric;   ///< of steps of the design
  /// Coordinates that stay at x0 and p0, in both: there derivatives are zero. Empty: none.
  FixedDofs fixed_state, fixed_design;
};

/// Both the state and the design as variables, z = (x, p), with f as constraints; restore() solves for the equilibrium
/// at the design of z, starting from its state.
class FullSpaceProgram : public NonlinearProgram {
 public:
  FullSpaceProgram(InverseDesign design, std::string name);
  FullSpaceProgram(const FullSpaceProgram&) = delete;  // what it keeps refers to its own terms

  std::string name() const override { return name_; }
  int variable_count() const override { return state_size_ + design_size_; }
  int constraint_count() const override { return state_size_; }
  Vec initial_point() const override { return join(design_.x0, design_.p0); }

  double objective(ConstVec z) const override;
  void objective_gradient(ConstVec z, Vec& g) const override;
  void gauss_newton_hessian(ConstVec z, SparseMatrix& H) const override;
  void constraints(ConstVec z, Vec& c) const override;
  void constraint_jacobian(ConstVec z, SparseMatrix& J) const override;
  /// Where every term has an exact Hessian.
  bool lagrangian_hessian(ConstVec z, ConstVec lambda, SparseMatrix& H) const override;
  Eigen::MatrixXd dense_curvature(ConstVec z) const override;
  std::optional<Vec> adjoint_multipliers(ConstVec z) const override;
  void step_metric(ConstVec z, SparseMatrix& D) const override;
  std::optional<Vec> restore(ConstVec z) const override;
  int inner_linear_solves() const override
  {
    return design_.constraint->linear_solves() + (design_.coupled_term ? design_.coupled_term->linear_solves() : 0);
  }

  Eigen::Ref<const Vec> state(ConstVec z) const { return z.head(state_size_); }
  Eigen::Ref<const Vec> design(ConstVec z) const { return z.tail(design_size_); }

 private:
  static Vec join(ConstVec x, ConstVec p);

  InverseDesign design_;
  std::string name_;
  int state_size_, design_size_;
  FixedDofs fixed_;  // of z
  mutable TermHessians state_hessians_, design_hessians_;
  mutable SparseSum hessian_, lagrangian_, metric_, jacobian_;
  mutable SparseMatrix K_, B_, D_, xx_, mixed_, pp_;
};

}  // namespace softform
