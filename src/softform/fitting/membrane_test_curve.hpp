#pragma once

#include <array>

#include "softform/core/types.hpp"
#include "softform/materials/material.hpp"

namespace softform {

/// States of an inflated sheet in the order of their volume (n each).
struct InflationCurve {
  Vec volume;     ///< [m^3]
  Vec extension;  ///< averaged extension ratio (4.8)
  Vec pressure;   ///< [Pa]

  /// Values inside the curve, linear between its states.
  double pressure_at_extension(double wanted) const;
  double pressure_at_volume(double wanted) const;
  double extension_at_volume(double wanted) const;
};

/// The exact curve of a clamped circular sheet up to a volume [m^3], by inflated_circle. Throws InputError as that
/// does.
InflationCurve inflation_curve(const Material& material, double thickness, double radius, double largest_volume);

/// The three regimes of 4.3.2 in a measured curve, as four extensions that bound them. The stiffness is dp/d(extension)
/// between successive states; it falls to a least value, negative past a limit point of the pressure, and rises again.
/// The first regime ends, and the third begins, half way between the first, or last, stiffness and the least.
/// Throws InputError for a curve of less than six states or without three regimes: the first and the last stiffness
/// must be positive and exceed `contrast` times the least.
std::array<double, 4> three_regimes(const InflationCurve& measured, double contrast = 2);

/// The mean stiffness of a curve between two extensions [Pa per unit of extension].
double mean_stiffness(const InflationCurve& curve, double from, double to);

/// The mean stiffness of a curve in each regime [Pa per unit of extension].
std::array<double, 3> regime_stiffness(const InflationCurve& curve, const std::array<double, 4>& bounds);

}  // namespace softform
