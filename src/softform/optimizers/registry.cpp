#include "softform/optimizers/registry.hpp"

#include <fmt/format.h>

#include "softform/core/error.hpp"
#include "softform/optimizers/augmented_lagrangian.hpp"
#include "softform/optimizers/ceres_adapter.hpp"
#include "softform/optimizers/feasible_newton.hpp"
#include "softform/optimizers/gradient_projection.hpp"
#include "softform/optimizers/lbfgs.hpp"
#include "softform/optimizers/nlopt_adapter.hpp"
#include "softform/optimizers/quadratic_penalty.hpp"
#include "softform/optimizers/reduced_gauss_newton.hpp"
#include "softform/optimizers/sqp.hpp"
#ifdef SOFTFORM_WITH_IPOPT
#include "softform/optimizers/ipopt_adapter.hpp"
#endif

namespace softform {
namespace {

template <class Method>
std::unique_ptr<Optimizer> make()
{
  return std::make_unique<Method>();
}

template <NloptMethod method>
std::unique_ptr<Optimizer> make_nlopt()
{
  return std::make_unique<NloptAdapter>(method);
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
       true, make<ReducedGaussNewton>, true},
      {"feasible_newton", "Gauss-Newton, then exact Newton on the KKT system, and a feasible point again", true, false,
       make<FeasibleNewton>, true},
      {"augmented_lagrangian", "augmented Lagrangian, Newton's method inside", true, true, make<AugmentedLagrangian>},
      {"augmented_lagrangian_gauss_newton", "augmented Lagrangian, Gauss-Newton inside", true, true,
       make_gauss_newton_lagrangian},
      {"quadratic_penalty", "quadratic penalty, Newton's method inside", true, true, make<QuadraticPenalty>},
      {"gradient_projection", "Newton's method on the faces of the bounds", false, true, make<GradientProjection>},
      {"lbfgs", "limited-memory BFGS, preconditioned by the programme's metric", false, false, make<Lbfgs>},
      {"sqp", "Newton on the first-order conditions, l1 merit (Byrd, Curtis, Nocedal 2010)", true, false, make<Sqp>},
      {"nlopt_slsqp", "NLopt: dense sequential least squares (Kraft 1994)", true, true, make_nlopt<NloptMethod::Slsqp>},
      {"nlopt_mma", "NLopt: conservative approximations (Svanberg 2002)", false, true, make_nlopt<NloptMethod::Mma>},
      {"nlopt_lbfgs", "NLopt: limited-memory BFGS (Luksan)", false, true, make_nlopt<NloptMethod::Lbfgs>},
      {"nlopt_auglag", "NLopt: augmented Lagrangian around L-BFGS", true, true, make_nlopt<NloptMethod::AugLag>},
      {"ceres", "Ceres: Levenberg-Marquardt on residuals", false, true, make<CeresAdapter>, false, true},
#ifdef SOFTFORM_WITH_IPOPT
      {"ipopt", "IPOPT: interior point (Waechter and Biegler 2006)", true, true, make<IpoptAdapter>},
#endif
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
