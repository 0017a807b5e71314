#include "softform/inverse/rest_shape_design.hpp"

#include <limits>
#include <utility>

#include "softform/inverse/full_space_program.hpp"
#include "softform/objectives/edge_dihedral.hpp"

namespace softform {
namespace {

// What both formulations share: the terms, the forces and the forward solve.
class DesignProblem : public EquilibriumConstraint {
 public:
  explicit DesignProblem(RestShapeDesign design)
      : design_(std::move(design)),
        size_(static_cast<int>(design_.x0.size())),
        balloon_(*design_.membrane, design_.rest_positions0),
        potential_(balloon_, design_.pressure, design_.x0)
  {}

  int size() const { return size_; }

  // dW/dx - p dV/dx, dimensionless.
  void forces(ConstVec x, ConstVec rest, Vec& f) override
  {
    balloon_.set_rest_positions(rest);
    potential_.gradient(x, f);
    f /= design_.force_scale;
    design_.fixed.project(f);
  }

  void state_jacobian(ConstVec x, ConstVec rest, SparseMatrix& K) override
  {
    balloon_.set_rest_positions(rest);
    potential_.hessian(x, K);
    K.coeffs() /= design_.force_scale;
    if (design_.fixed.free.size() > 0) design_.fixed.project(K, K.diagonal().cwiseAbs().mean());
  }

  void design_jacobian(ConstVec x, ConstVec rest, SparseMatrix& B) override
  {
    design_.membrane->mixed_hessian(x, rest, B);
    B.coeffs() /= design_.force_scale;
    design_.fixed.project(B, 0);
  }

  // The Hessian of lambda . f in (x, X), by blocks. The volume is cubic: its third derivative along lambda is its
  // second at lambda.
  void force_hessian(ConstVec x, ConstVec rest, ConstVec lambda, SparseMatrix& xx, SparseMatrix& mixed,
                     SparseMatrix& XX) override
  {
    const Vec scaled = lambda / design_.force_scale;
    design_.membrane->force_hessian(x, rest, scaled, xx, mixed, XX);
    balloon_.volume().add_hessian(scaled, -design_.pressure, xx);
    for (SparseMatrix* block : {&xx, &mixed, &XX}) design_.fixed.project(*block, 0);
  }

  // A stable equilibrium at an admissible `rest` from x, or nothing.
  std::optional<Vec> equilibrium(ConstVec x, ConstVec rest) override
  {
    if (design_.is_admissible && !design_.is_admissible(rest)) return std::nullopt;
    balloon_.set_rest_positions(rest);
    Equilibrium found = solve_at_pressure(balloon_, design_.pressure, x, factorization_, design_.newton, design_.fixed);
    if (design_.on_equilibrium) design_.on_equilibrium(found);
    if (!found.report.converged()) return std::nullopt;
    return std::move(found.x);
  }

  // The objectives do not see rigid motions either, so that b has none of them.
  Vec solve_state(ConstVec x, ConstVec rest, const Vec& b) override
  {
    state_jacobian(x, rest, K_);
    shift_diagonal(K_, design_.newton.rigid_shift * K_.diagonal().cwiseAbs().mean());
    if (!factorization_.cholesky(K_)) return Vec::Constant(b.size(), std::numeric_limits<double>::quiet_NaN());
    return factorization_.solve(b);
  }
  int linear_solves() const override { return factorization_.attempts(); }

 private:
  RestShapeDesign design_;
  int size_;
  PressurizedMembrane balloon_;
  PressurePotential potential_;
  SparseFactorization factorization_;
  SparseMatrix K_;
};

// The Sobolev metric: steps are measured by how much they change the rest shape's lengths and angles.
class RestShapeMetric {
 public:
  explicit RestShapeMetric(const RestShapeDesign& design)
      : shape_(design.membrane->triangles(), design.rest_positions0), fixed_(design.fixed)
  {}

  void evaluate(ConstVec rest, SparseMatrix& D)
  {
    shape_.set_target(rest);
    shape_.gauss_newton_hessian(rest, D);
    if (fixed_.free.size() > 0) fixed_.project(D, D.diagonal().mean());
  }

 private:
  EdgeDihedralDistance shape_;
  FixedDofs fixed_;
};

class ReducedProgram : public NonlinearProgram {
 public:
  explicit ReducedProgram(const RestShapeDesign& design)
      : design_(design),
        problem_(design_),
        shape_metric_(design_),
        design_hessians_(design_.design_terms),
        hessian_(problem_.size()),
        x_(design.x0)
  {}

  std::string name() const override { return "rest shape, reduced"; }
  int variable_count() const override { return problem_.size(); }
  int constraint_count() const override { return 0; }
  Vec initial_point() const override { return design_.rest_positions0; }

  double objective(ConstVec rest) const override
  {
    if (!update_state(rest)) return std::numeric_limits<double>::infinity();
    return weighted_value(design_.state_terms, x_) + weighted_value(design_.design_terms, rest);
  }
  // dE/dX - B^t K^-1 dE/dx: one adjoint solve.
  void objective_gradient(ConstVec rest, Vec& g) const override
  {
    if (!update_state(rest)) {
      g.setConstant(rest.size(), std::numeric_limits<double>::quiet_NaN());
      return;
    }
    problem_.design_jacobian(x_, rest, B_);
    Vec state_gradient = weighted_gradient(design_.state_terms, x_);
    design_.fixed.project(state_gradient);
    g = weighted_gradient(design_.design_terms, rest) - B_.transpose() * problem_.solve_state(x_, rest, state_gradient);
    design_.fixed.project(g);
  }
  void gauss_newton_hessian(ConstVec rest, SparseMatrix& H) const override
  {
    hessian_.clear();
    design_hessians_.add_gauss_newton(hessian_, rest, 0);
    H = hessian_.matrix();
    design_.fixed.project(H, 0);
  }
  void constraints(ConstVec, Vec& c) const override { c.resize(0); }
  void constraint_jacobian(ConstVec, SparseMatrix& J) const override { J.resize(0, variable_count()); }
  void step_metric(ConstVec rest, SparseMatrix& D) const override { shape_metric_.evaluate(rest, D); }
  int inner_linear_solves() const override { return problem_.linear_solves(); }

 private:
  // The equilibrium is found from the first one, not from the last: the objective stays a function of X alone.
  bool update_state(ConstVec rest) const
  {
    if (rest_.size() == rest.size() && rest_ == rest) return is_solved_;
    rest_ = rest;
    const auto x = problem_.equilibrium(design_.x0, rest);
    is_solved_ = x.has_value();
    if (x) x_ = *x;
    return is_solved_;
  }

  RestShapeDesign design_;
  mutable DesignProblem problem_;
  mutable RestShapeMetric shape_metric_;
  mutable TermHessians design_hessians_;
  mutable SparseSum hessian_;
  mutable SparseMatrix B_;
  mutable Vec x_, rest_;
  mutable bool is_solved_ = false;
};

}  // namespace

std::unique_ptr<NonlinearProgram> full_space_program(const RestShapeDesign& design)
{
  const auto metric = std::make_shared<RestShapeMetric>(design);
  return std::make_unique<FullSpaceProgram>(
      InverseDesign{.constraint = std::make_shared<DesignProblem>(design),
                    .x0 = design.x0,
                    .p0 = design.rest_positions0,
                    .state_terms = design.state_terms,
                    .design_terms = design.design_terms,
                    .metric = [metric](ConstVec rest, SparseMatrix& D) { metric->evaluate(rest, D); },
                    .fixed_state = design.fixed,
                    .fixed_design = design.fixed},
      "rest shape, full space");
}

std::unique_ptr<NonlinearProgram> reduced_program(const RestShapeDesign& design)
{
  return std::make_unique<ReducedProgram>(design);
}

}  // namespace softform
