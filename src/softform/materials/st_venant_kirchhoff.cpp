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
  return {"st_venant_kirchhoff",
          {{"lambda", "Pa", Range::Positive, 1, -2.0 / 3}, {"mu", "Pa"}},  // lambda > -2/3 mu
          false,
          make_material_of<StVenantKirchhoff>,
          density_by_parameters_of<StVenantKirchhoff>};
}

}  // namespace softform
