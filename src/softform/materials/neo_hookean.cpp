#include "softform/materials/neo_hookean.hpp"

#include <fmt/format.h>

#include "softform/core/error.hpp"

namespace softform {

void check_parameters(const NeoHookean<double>& model)
{
  if (model.mu <= 0)
    throw InputError(fmt::format("neo_hookean: mu = {:g} Pa is the shear modulus and must be positive", model.mu));
}

MaterialModel neo_hookean_model() { return material_model_of<NeoHookean>("neo_hookean", {{"mu", "Pa"}}); }

}  // namespace softform
