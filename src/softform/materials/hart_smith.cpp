#include "softform/materials/hart_smith.hpp"

#include <fmt/format.h>

#include "softform/core/error.hpp"

namespace softform {

void check_parameters(const HartSmith<double>& model)
{
  if (model.G <= 0) throw InputError(fmt::format("hart_smith: G = {:g} Pa is a modulus and must be positive", model.G));
  if (model.k1 < 0)
    throw InputError(
        fmt::format("hart_smith: k1 = {:g} is negative, so the rubber would "
                    "soften without end: take k1 >= 0",
                    model.k1));
  if (model.k2 < 0)
    throw InputError(
        fmt::format("hart_smith: k2 = {:g} is negative, so the energy falls "
                    "without bound in I2: take k2 >= 0",
                    model.k2));
}

MaterialModel hart_smith_model()
{
  return material_model_of<HartSmith>("hart_smith",
                                      {{"G", "Pa"}, {"k1", "1", Range::NonNegative}, {"k2", "1", Range::NonNegative}});
}

}  // namespace softform
