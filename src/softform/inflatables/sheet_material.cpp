#include "softform/inflatables/sheet_material.hpp"

namespace softform {

std::shared_ptr<const TensionField> sheet_material(const Material& material, double thickness, double pressure,
                                                   double size, double residual)
{
  const double kappa = material.shear_modulus() / 2;
  return std::make_shared<TensionField>(kappa, 0, residual * pressure * size / (kappa * thickness));
}

}  // namespace softform
