#include "softform/inflatables/sheet_material.hpp"

#include <cmath>

#include "softform/materials/barrier_tension_field.hpp"
#include "softform/materials/tension_field.hpp"

namespace softform {

std::shared_ptr<const Material> sheet_material(const Material& material, double thickness, double pressure, double size,
                                               double residual)
{
  const double kappa = material.shear_modulus() / 2;
  return std::make_shared<TensionField>(kappa, 0, residual * pressure * size / (kappa * thickness));
}

InflationSettings sheet_inflation(const Material& material, double thickness, double pressure, double size)
{
  return {
      .material = sheet_material(material, thickness, pressure, size), .thickness = thickness, .pressure = pressure};
}

InflationSettings design_inflation(const Material& material, double thickness, double pressure, double size)
{
  constexpr double residual = 3e-3;
  const double kappa = material.shear_modulus() / 2, compliance = pressure * size / (kappa * thickness);
  const double sphere_stress = compliance / 8;  // N of BarrierTensionField: 2 kappa N h = p (L/2) / 2
  const auto sheets = [&](double transition) {
    return std::make_shared<BarrierTensionField>(kappa, std::pow(transition * sphere_stress, 2), residual * compliance);
  };
  InflationSettings settings{
      .material = sheets(0.25), .first_material = sheets(0.5), .thickness = thickness, .pressure = pressure};
  // Soft motions magnify what is left of forces, and the objective is compared to a millionth.
  settings.newton.tolerance = 1e-9;
  return settings;
}

}  // namespace softform
