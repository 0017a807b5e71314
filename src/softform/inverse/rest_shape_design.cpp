#include "softform/inverse/rest_shape_design.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "softform/linalg/sparse_sum.hpp"
#include "softform/objectives/edge_dihedral.hpp"

namespace softform {
namespace {

// What both formulations share: the terms, the forces and the forward solve.
class DesignProblem {
 public:
  explicit DesignProblem(const RestShapeDesign& design)
      : design_(design),
        size_(static_cast<int>(design.x0.size())),
        balloon_(*design.membrane, design.rest_positions0),
        potential_(balloon_, design.pressure, design.x0)
  {}

  const RestShapeDesign& design() const { return design_; }
  int size() const { return size_; }

  // dW/dx - p dV/dx, dimensionless.
  void forces(ConstVec x, ConstVec rest, Vec& f)
  {
    balloon_.set_rest_positions(rest);
    potential_.gradient(x, f);
    f /= design_.force_scale;
    design_.fixed.project(f);
  }

  void state_jacobian(ConstVec x, ConstVec rest, SparseMatrix& K)
  {
    balloon_.set_rest_positions(rest);
    potential_.hessian(x, K);
    K.coeffs() /= design_.force_scale;
    if (design_.fixed.free.size() > 0) design_.fixed.project(K, K.diagonal().cwiseAbs().mean());
  }

  void design_jacobian(ConstVec x, ConstVec rest, SparseMatrix& B)
  {
    design_.membrane->mixed_hessian(x, rest, B);
    B.coeffs() /= design_.force_scale;
    design_.fixed.project(B, 0);
  }

  // The Hessian of lambda . f in (x, X), by blocks. The volume is cubic: its third derivative along lambda is its
  // second at lambda.
  void force_hessian(ConstVec x, ConstVec rest, ConstVec lambda, SparseMatrix& xx, SparseMatrix& mixed,
                     SparseMatrix& XX)
  {
    const Vec scaled = lambda / design_.force_scale;
    design_.membrane->force_hessian(x, rest, scaled, xx, mixed, XX);
    balloon_.volume().add_hessian(scaled, -design_.pressure, xx);
    for (SparseMatrix* block : {&xx, &mixed, &XX}) design_.fixed.project(*block, 0);
  }

  // A stable equilibrium at an admissible `rest` from x, or nothing.
  std::optional<Vec> equilibrium(ConstVec x, ConstVec rest)
  {
    if (design_.is_admissible && !design_.is_admissible(rest)) return std::nullopt;
    balloon_.set_rest_positions(rest);
    Equilibrium found = solve_at_pressure(balloon_, design_.pressure, x, factorization_, design_.newton, design_.fixed);
    if (design_.on_equilibrium) design_.on_equilibrium(found);
    if (!found.report.converged()) return std::nullopt;
    return std::move(found.x);
  }

  SparseFactorization& factorization() { return factorization_; }
  int linear_solves() const { return factorization_.attempts(); }

 private:
  const RestShapeDesign& design_;
  int size_;
  PressurizedMembrane balloon_;
  PressurePotential potential_;
  SparseFactorization factorization_;
};

double weighted_value(const std::vector<WeightedObjective>& terms, ConstVec x)
{
  double sum = 0;
  for (const auto& [weight, objective] : terms) sum += weight * objective->value(x);
  return sum;
}

Vec weighted_gradient(const std::vector<WeightedObjective>& terms, ConstVec x)
{
  Vec sum = Vec::Zero(x.size()), g;
  for (const auto& [weight, objective] : terms) {
    objective->gradient(x, g);
    sum += weight * g;
  }
  return sum;
}

// The Gauss-Newton Hessians of terms, each kept with its pattern between calls.
class TermHessians {
 public:
  explicit TermHessians(const std::vector<WeightedObjective>& terms) : terms_(terms), hessians_(terms.size()) {}

  // Adds them to the diagonal block of `sum` that starts at `offset`.
  void add_to(SparseSum& sum, ConstVec x, int offset)
  {
    for (std::size_t k = 0; k < terms_.size(); ++k) {
      terms_[k].objective->gauss_newton_hessian(x, hessians_[k]);
      sum.add(hessians_[k], terms_[k].weight, offset, offset);
    }
  }

 private:
  const std::vector<WeightedObjective>& terms_;
  std::vector<SparseMatrix> hessians_;
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
  const FixedDofs& fixed_;
};

class FullSpaceProgram : public NonlinearProgram {
 public:
  explicit FullSpaceProgram(const RestShapeDesign& design)
      : design_(design),
        problem_(design_),
        shape_metric_(design_),
        state_hessians_(design_.state_terms),
        design_hessians_(design_.design_terms),
        hessian_(2 * problem_.size()),
        metric_(2 * problem_.size()),
        lagrangian_(2 * problem_.size())
  {
    if (design_.fixed.free.size() > 0) fixed_.free = join(design_.fixed.free, design_.fixed.free);
  }

  std::string name() const override { return "rest shape, full space"; }
  int variable_count() const override { return 2 * problem_.size(); }
  int constraint_count() const override { return problem_.size(); }
  Vec initial_point() const override { return join(design_.x0, design_.rest_positions0); }

  double objective(ConstVec z) const override
  {
    return weighted_value(design_.state_terms, state(z)) + weighted_value(design_.design_terms, rest(z));
  }
  void objective_gradient(ConstVec z, Vec& g) const override
  {
    g = join(weighted_gradient(design_.state_terms, state(z)), weighted_gradient(design_.design_terms, rest(z)));
    fixed_.project(g);
  }
  void gauss_newton_hessian(ConstVec z, SparseMatrix& H) const override
  {
    hessian_.clear();
    state_hessians_.add_to(hessian_, state(z), 0);
    design_hessians_.add_to(hessian_, rest(z), problem_.size());
    H = hessian_.matrix();
    fixed_.project(H, 0);
  }
  void constraints(ConstVec z, Vec& c) const override { problem_.forces(state(z), rest(z), c); }
  void constraint_jacobian(ConstVec z, SparseMatrix& J) const override;
  bool lagrangian_hessian(ConstVec z, ConstVec lambda, SparseMatrix& H) const override;
  void step_metric(ConstVec z, SparseMatrix& D) const override
  {
    shape_metric_.evaluate(rest(z), D_);
    metric_.clear();
    metric_.add(D_, 1, problem_.size(), problem_.size());
    D = metric_.matrix();
  }
  std::optional<Vec> restore(ConstVec z) const override
  {
    const auto x = problem_.equilibrium(state(z), rest(z));
    if (!x) return std::nullopt;
    return join(*x, rest(z));
  }
  int inner_linear_solves() const override { return problem_.linear_solves(); }

 private:
  Eigen::Ref<const Vec> state(ConstVec z) const { return z.head(problem_.size()); }
  Eigen::Ref<const Vec> rest(ConstVec z) const { return z.tail(problem_.size()); }
  static Vec join(ConstVec x, ConstVec rest)
  {
    Vec z(x.size() + rest.size());
    z << x, rest;
    return z;
  }

  RestShapeDesign design_;
  mutable DesignProblem problem_;
  mutable RestShapeMetric shape_metric_;
  mutable TermHessians state_hessians_, design_hessians_;
  mutable SparseSum hessian_, metric_, lagrangian_;
  mutable SparseMatrix K_, B_, D_;
  FixedDofs fixed_;  // of z
};

// Where every term has an exact Hessian.
bool FullSpaceProgram::lagrangian_hessian(ConstVec z, ConstVec lambda, SparseMatrix& H) const
{
  const int n = problem_.size();
  lagrangian_.clear();
  const auto add_terms = [&](const std::vector<WeightedObjective>& terms, ConstVec positions, int offset) {
    for (const auto& [weight, objective] : terms) {
      SparseMatrix term;
      if (!objective->hessian(positions, term)) return false;
      lagrangian_.add(term, weight, offset, offset);
    }
    return true;
  };
  if (!add_terms(design_.state_terms, state(z), 0) || !add_terms(design_.design_terms, rest(z), n)) return false;
  SparseMatrix xx, mixed, XX;
  problem_.force_hessian(state(z), rest(z), lambda, xx, mixed, XX);
  lagrangian_.add(xx, 1, 0, 0);
  lagrangian_.add(mixed, 1, 0, n);
  lagrangian_.add(SparseMatrix(mixed.transpose()), 1, n, 0);
  lagrangian_.add(XX, 1, n, n);
  H = lagrangian_.matrix();
  fixed_.project(H, 0);
  return true;
}

// J = [K B]: compressed columns of the two, one after the other.
void FullSpaceProgram::constraint_jacobian(ConstVec z, SparseMatrix& J) const
{
  const int n = problem_.size();
  problem_.state_jacobian(state(z), rest(z), K_);
  problem_.design_jacobian(state(z), rest(z), B_);
  const Eigen::Index nonzeros = K_.nonZeros() + B_.nonZeros();
  if (J.rows() != n || J.cols() != 2 * n || J.nonZeros() != nonzeros) {
    J.resize(n, 2 * n);
    J.resizeNonZeros(nonzeros);
    std::copy_n(K_.outerIndexPtr(), n, J.outerIndexPtr());
    const int offset = static_cast<int>(K_.nonZeros());
    std::transform(B_.outerIndexPtr(), B_.outerIndexPtr() + n + 1, J.outerIndexPtr() + n,
                   [offset](int start) { return start + offset; });
    std::copy_n(K_.innerIndexPtr(), K_.nonZeros(), J.innerIndexPtr());
    std::copy_n(B_.innerIndexPtr(), B_.nonZeros(), J.innerIndexPtr() + offset);
  }
  std::copy_n(K_.valuePtr(), K_.nonZeros(), J.valuePtr());
  std::copy_n(B_.valuePtr(), B_.nonZeros(), J.valuePtr() + K_.nonZeros());
}

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
    problem_.state_jacobian(x_, rest, K_);
    problem_.design_jacobian(x_, rest, B_);
    shift_diagonal(K_, design_.newton.rigid_shift * K_.diagonal().cwiseAbs().mean());
    problem_.factorization().cholesky(K_);
    Vec state_gradient = weighted_gradient(design_.state_terms, x_);
    design_.fixed.project(state_gradient);
    g = weighted_gradient(design_.design_terms, rest) - B_.transpose() * problem_.factorization().solve(state_gradient);
    design_.fixed.project(g);
  }
  void gauss_newton_hessian(ConstVec rest, SparseMatrix& H) const override
  {
    hessian_.clear();
    design_hessians_.add_to(hessian_, rest, 0);
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
  mutable SparseMatrix K_, B_;
  mutable Vec x_, rest_;
  mutable bool is_solved_ = false;
};

}  // namespace

std::unique_ptr<NonlinearProgram> full_space_program(const RestShapeDesign& design)
{
  return std::make_unique<FullSpaceProgram>(design);
}

std::unique_ptr<NonlinearProgram> reduced_program(const RestShapeDesign& design)
{
  return std::make_unique<ReducedProgram>(design);
}

}  // namespace softform
