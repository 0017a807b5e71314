#include "softform/materials/st_venant_kirchhoff.hpp"

#include <fmt/format.h>

#include "softform/core/error.hpp"

namespace softform {

void check_parameters(const StVenantKirchhoff<double>& model)
{
  if (model.mu <= 0)
    throw InputError(
        fmt::format("st_venant_kirchhoff: mu = {:g} Pa is the "
                    "shear modulus and must be positive",
                    model.mu));
  if (3 * model.lambda + 2 * model.mu <= 0)
    throw InputError(
        fmt::format("st_venant_kirchhoff: lambda = {:g} Pa must exceed -2 "
                    "mu/3, or dilation lowers the energy",
                    model.lambda));
}

MaterialModel st_venant_kirchhoff_model()
{
  return material_model_of<StVenantKirchhoff>("st_venant_kirchhoff",
                                              {{"lambda", "Pa", Range::Positive, 1, -2.0 / 3},  // lambda > -2/3 mu
                                               {"mu", "Pa"}});
}

}  // namespace softform
