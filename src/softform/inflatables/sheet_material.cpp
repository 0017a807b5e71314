#include "softform/inflatables/sheet_material.hpp"

namespace softform {

std::shared_ptr<const TensionField> sheet_material(const Material& material, double thickness, double pressure,
                                                   double size, double residual, double smoothing)
{
  const double kappa = material.shear_modulus() / 2;
  return std::make_shared<TensionField>(kappa, smoothing, residual * pressure * size / (kappa * thickness));
}

std::shared_ptr<const TensionField> sheet_material_for_design(const Material& material, double thickness,
                                                              double pressure, double size)
{
  return sheet_material(material, thickness, pressure, size, 2e-3, 0.05);
}

}  // namespace softform
