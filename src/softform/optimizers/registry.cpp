#include "softform/optimizers/registry.hpp"

#include <fmt/format.h>

#include "softform/core/error.hpp"
#include "softform/optimizers/augmented_lagrangian.hpp"
#include "softform/optimizers/gradient_projection.hpp"
#include "softform/optimizers/lbfgs.hpp"
#include "softform/optimizers/quadratic_penalty.hpp"
#include "softform/optimizers/reduced_gauss_newton.hpp"

namespace softform {
namespace {

template <class Method>
std::unique_ptr<Optimizer> make()
{
  return std::make_unique<Method>();
}

std::unique_ptr<Optimizer> make_gauss_newton_lagrangian()
{
  AugmentedLagrangianOptions options;
  options.newton.hessian = HessianModel::GaussNewton;
  return std::make_unique<AugmentedLagrangian>(options);
}

}  // namespace

const std::vector<OptimizerEntry>& optimizers()
{
  static const std::vector<OptimizerEntry> entries{
      {"reduced_gauss_newton", "Gauss-Newton step, then a feasible point again (programmes that can restore)", true,
       false, make<ReducedGaussNewton>, true},
      {"augmented_lagrangian", "augmented Lagrangian, Newton's method inside", true, true, make<AugmentedLagrangian>},
      {"augmented_lagrangian_gauss_newton", "augmented Lagrangian, Gauss-Newton inside", true, true,
       make_gauss_newton_lagrangian},
      {"quadratic_penalty", "quadratic penalty, Newton's method inside", true, true, make<QuadraticPenalty>},
      {"gradient_projection", "Newton's method on the faces of the bounds", false, true, make<GradientProjection>},
      {"lbfgs", "limited-memory BFGS, preconditioned by the programme's metric", false, false, make<Lbfgs>},
  };
  return entries;
}

std::unique_ptr<Optimizer> make_optimizer(const std::string& name)
{
  std::string known;
  for (const OptimizerEntry& entry : optimizers()) {
    if (entry.name == name) return entry.make();
    known += (known.empty() ? "" : ", ") + entry.name;
  }
  throw InputError(fmt::format("there is no optimiser '{}'; known are {}", name, known));
}

}  // namespace softform
