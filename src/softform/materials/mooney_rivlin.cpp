#include "softform/materials/mooney_rivlin.hpp"

#include <fmt/format.h>

#include "softform/core/error.hpp"

namespace softform {

void check_parameters(const MooneyRivlin<double>& model)
{
  for (const auto& [name, value] : {std::pair("mu_1", model.mu_1), std::pair("mu_2", model.mu_2)}) {
    if (value < 0)
      throw InputError(
          fmt::format("mooney_rivlin: {} = {:g} Pa is negative, so the energy "
                      "falls without bound: take {} >= 0",
                      name, value, name));
  }
  if (model.shear_modulus() <= 0)
    throw InputError("mooney_rivlin: mu_1 + mu_2 is the shear modulus and must be positive");
}

MaterialModel mooney_rivlin_model()
{
  return material_model_of<MooneyRivlin>("mooney_rivlin",
                                         {{"mu_1", "Pa", Range::NonNegative}, {"mu_2", "Pa", Range::NonNegative}});
}

}  // namespace softform
