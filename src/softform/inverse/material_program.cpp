#include "softform/inverse/material_program.hpp"

#include <limits>
#include <utility>

#include "softform/core/error.hpp"

namespace softform {
namespace {

template <int dim>
class MaterialProgram final : public NonlinearProgram {
 public:
  using State = typename MaterialDesign<dim>::State;

  MaterialProgram(MaterialDesign<dim>& design, State first, const MaterialWeights& weights)
      : design_(design), first_(std::move(first)), weights_(weights)
  {
    if (design_.has_free_pins())
      throw InputError("the pins of a material programme stay where they are: do not let them be free");
  }

  std::string name() const override { return "material distribution, reduced"; }
  int variable_count() const override { return static_cast<int>(first_.rho.size()); }
  int constraint_count() const override { return 0; }
  Vec initial_point() const override { return first_.rho; }
  Vec lower_bounds() const override { return Vec::Zero(first_.rho.size()); }
  Vec upper_bounds() const override { return Vec::Ones(first_.rho.size()); }

  double objective(ConstVec rho) const override
  {
    update(rho);
    return state_ ? design_.objective(*state_, weights_) : std::numeric_limits<double>::infinity();
  }
  void objective_gradient(ConstVec rho, Vec& g) const override
  {
    update(rho);
    if (state_ && design_.linearize(*state_, weights_))
      design_.gradient(g);
    else
      g.setConstant(rho.size(), std::numeric_limits<double>::quiet_NaN());
  }
  // That of the regularisers: the distances have no sparse one.
  void gauss_newton_hessian(ConstVec, SparseMatrix& H) const override { H = design_.regulariser_hessian(weights_); }
  void constraints(ConstVec, Vec& c) const override { c.resize(0); }
  void constraint_jacobian(ConstVec, SparseMatrix& J) const override { J.resize(0, variable_count()); }
  int inner_linear_solves() const override { return design_.linear_solves(); }

 private:
  void update(ConstVec rho) const
  {
    if (rho_.size() == rho.size() && rho_ == rho) return;
    rho_ = rho;
    state_ = design_.restart(first_, rho_);
  }

  MaterialDesign<dim>& design_;
  State first_;
  MaterialWeights weights_;
  mutable Vec rho_;
  mutable std::optional<State> state_;
};

}  // namespace

template <int dim>
std::unique_ptr<NonlinearProgram> material_program(MaterialDesign<dim>& design,
                                                   const typename MaterialDesign<dim>::State& first,
                                                   const MaterialWeights& weights)
{
  return std::make_unique<MaterialProgram<dim>>(design, first, weights);
}

template std::unique_ptr<NonlinearProgram> material_program<2>(MaterialDesign<2>&, const MaterialDesign<2>::State&,
                                                               const MaterialWeights&);
template std::unique_ptr<NonlinearProgram> material_program<3>(MaterialDesign<3>&, const MaterialDesign<3>::State&,
                                                               const MaterialWeights&);

}  // namespace softform
