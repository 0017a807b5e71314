#include "softform/balloons/spherical_balloon.hpp"

namespace softform {

double spherical_balloon_pressure(const Material& material, double thickness, double radius, double stretch)
{
  const double L = stretch;
  const MembraneDensity density = material.density(2 * L * L, L * L * L * L, Order::Gradient);
  const double W_L = density.psi_t * 4 * L + density.psi_d * 4 * L * L * L;
  return thickness / radius * W_L / (L * L);
}

}  // namespace softform
