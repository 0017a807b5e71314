#pragma once

#include "softform/fitting/shape_fit.hpp"

namespace softform {

/// The misfit of one simulated step and its derivatives in the free coordinates (3 n_f) and the pressure of a sheet of
/// `reference_thickness`: value, gradient and the blocks of the Gauss-Newton Hessian.
struct StepMisfit {
  double value = 0;
  Vec gradient;                          ///< in x (3 n_f)
  std::vector<Eigen::Matrix3d> hessian;  ///< diagonal blocks in x (n_f)
  double pressure_gradient = 0, pressure_hessian = 0;
};

/// The thickness of the simulated sheet [m]: pressures are proportional to it.
inline constexpr double reference_thickness = 1e-3;

StepMisfit step_misfit(const ShapeFit& fit, const ShapeStep& step, ConstVec x, double pressure);

/// The number of pressure-shape pairs.
int observation_count(const ShapeFit& fit);

/// Volumes of the steps for a simulated sheet [m^3].
std::vector<double> faceted_volumes(const ShapeFit& fit, const ClampedSheet& sheet);

void check(const ShapeFit& fit);

Vec log_magnitudes(const std::vector<double>& parameters);

}  // namespace softform
