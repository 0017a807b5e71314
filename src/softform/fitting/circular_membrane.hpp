#pragma once

#include "softform/materials/material.hpp"

namespace softform {

/// A state of an inflated circular membrane.
struct InflatedCircle {
  double pressure = 0;  ///< [Pa]
  double height = 0;    ///< of the pole above the clamp [m]
  double volume = 0;    ///< between the membrane and the plane of the clamp [m^3]
  double area = 0;      ///< of the membrane [m^2]
};

/// A flat circular membrane of rest `radius` a and `thickness` h [m], clamped at its rim and inflated to a stretch at
/// its pole, by the ordinary differential equations of an axisymmetric membrane (J. E. Adkins and R. S. Rivlin, Phil.
/// Trans. R. Soc. A 244, 1952): relative error 1e-8, without a mesh. Throws InputError unless pole_stretch > 1.
InflatedCircle inflated_circle(const Material& material, double thickness, double radius, double pole_stretch);

}  // namespace softform
