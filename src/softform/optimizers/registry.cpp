#include "softform/optimizers/registry.hpp"

#include <fmt/format.h>

#include "softform/core/error.hpp"
#include "softform/optimizers/reduced_gauss_newton.hpp"
#include "softform/optimizers/sqp.hpp"

namespace softform {
namespace {

template <class Method>
std::unique_ptr<Optimizer> make()
{
  return std::make_unique<Method>();
}

}  // namespace

const std::vector<OptimizerEntry>& optimizers()
{
  static const std::vector<OptimizerEntry> entries{
      {"reduced_gauss_newton", "Gauss-Newton step, then a feasible point again (programmes that can restore)", true,
       false, make<ReducedGaussNewton>},
      {"sqp", "Newton on the first-order conditions, l1 merit (Byrd, Curtis, Nocedal 2010)", true, false, make<Sqp>},
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
