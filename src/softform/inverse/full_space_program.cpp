#include "softform/inverse/full_space_program.hpp"

#include <utility>

namespace softform {

Vec FullSpaceProgram::join(ConstVec x, ConstVec p)
{
  Vec z(x.size() + p.size());
  z << x, p;
  return z;
}

FullSpaceProgram::FullSpaceProgram(InverseDesign design, std::string name)
    : design_(std::move(design)),
      name_(std::move(name)),
      state_size_(static_cast<int>(design_.x0.size())),
      design_size_(static_cast<int>(design_.p0.size())),
      state_hessians_(design_.state_terms),
      design_hessians_(design_.design_terms),
      hessian_(state_size_ + design_size_),
      lagrangian_(state_size_ + design_size_),
      metric_(state_size_ + design_size_),
      jacobian_(state_size_, state_size_ + design_size_)
{
  const auto free_of = [](const FixedDofs& fixed, int size) {
    return fixed.free.size() > 0 ? fixed.free : Vec(Vec::Ones(size));
  };
  if (design_.fixed_state.free.size() > 0 || design_.fixed_design.free.size() > 0)
    fixed_.free = join(free_of(design_.fixed_state, state_size_), free_of(design_.fixed_design, design_size_));
}

double FullSpaceProgram::objective(ConstVec z) const
{
  const double sum = weighted_value(design_.state_terms, state(z)) + weighted_value(design_.design_terms, design(z));
  return design_.coupled_term ? sum + design_.coupled_term->value(state(z), design(z)) : sum;
}

void FullSpaceProgram::objective_gradient(ConstVec z, Vec& g) const
{
  g = join(weighted_gradient(design_.state_terms, state(z)), weighted_gradient(design_.design_terms, design(z)));
  if (design_.coupled_term) g += design_.coupled_term->gradient(state(z), design(z));
  fixed_.project(g);
}

void FullSpaceProgram::gauss_newton_hessian(ConstVec z, SparseMatrix& H) const
{
  hessian_.clear();
  state_hessians_.add_gauss_newton(hessian_, state(z), 0);
  design_hessians_.add_gauss_newton(hessian_, design(z), state_size_);
  H = hessian_.matrix();
  fixed_.project(H, 0);
}

void FullSpaceProgram::constraints(ConstVec z, Vec& c) const { design_.constraint->forces(state(z), design(z), c); }

// J = [K B].
void FullSpaceProgram::constraint_jacobian(ConstVec z, SparseMatrix& J) const
{
  design_.constraint->state_jacobian(state(z), design(z), K_);
  design_.constraint->design_jacobian(state(z), design(z), B_);
  jacobian_.clear();
  jacobian_.add(K_, 1, 0, 0);
  jacobian_.add(B_, 1, 0, state_size_);
  J = jacobian_.matrix();
}

bool FullSpaceProgram::lagrangian_hessian(ConstVec z, ConstVec lambda, SparseMatrix& H) const
{
  const int n = state_size_;
  lagrangian_.clear();
  if (!state_hessians_.add_exact(lagrangian_, state(z), 0) || !design_hessians_.add_exact(lagrangian_, design(z), n))
    return false;
  design_.constraint->force_hessian(state(z), design(z), lambda, xx_, mixed_, pp_);
  lagrangian_.add(xx_, 1, 0, 0);
  lagrangian_.add(mixed_, 1, 0, n);
  lagrangian_.add(SparseMatrix(mixed_.transpose()), 1, n, 0);
  lagrangian_.add(pp_, 1, n, n);
  H = lagrangian_.matrix();
  fixed_.project(H, 0);
  return true;
}

Eigen::MatrixXd FullSpaceProgram::dense_curvature(ConstVec z) const
{
  return design_.coupled_term ? design_.coupled_term->curvature_factors(state(z), design(z))
                              : NonlinearProgram::dense_curvature(z);
}

std::optional<Vec> FullSpaceProgram::adjoint_multipliers(ConstVec z) const
{
  Vec g = weighted_gradient(design_.state_terms, state(z));
  if (design_.coupled_term) g += state(design_.coupled_term->gradient(state(z), design(z)));
  design_.fixed_state.project(g);
  return -design_.constraint->solve_state(state(z), design(z), g);
}

void FullSpaceProgram::step_metric(ConstVec z, SparseMatrix& D) const
{
  design_.metric(design(z), D_);
  metric_.clear();
  metric_.add(D_, 1, state_size_, state_size_);
  D = metric_.matrix();
}

std::optional<Vec> FullSpaceProgram::restore(ConstVec z) const
{
  const auto x = design_.constraint->equilibrium(state(z), design(z));
  if (!x) return std::nullopt;
  return join(*x, design(z));
}

}  // namespace softform
