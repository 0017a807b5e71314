#pragma once

#include <Eigen/Core>

#include "softform/fitting/rubber_test.hpp"
#include "softform/materials/material_model.hpp"

namespace softform {

/// Nominal stresses P_i = dW/dl_i [Pa] of an incompressible sheet in plane stress, W(l_1, l_2) = Psi(t, d):
///     P_1 = 2 l_1 (Psi_t + l_2^2 Psi_d),   P_2 = 2 l_2 (Psi_t + l_1^2 Psi_d).
/// NaN outside the density's domain.
Eigen::Array2d nominal_stress(const Material& material, const Stretches& stretches);

/// The same of a model at these parameters, which are not checked.
Eigen::Array2d nominal_stress(const MaterialModel& model, const std::vector<double>& parameters,
                              const Stretches& stretches);

/// With derivatives by the parameters. Precondition: at most Dual::variables of them.
struct StressByParameters {
  Eigen::Array2d stress;                                  ///< [Pa]
  Eigen::Array<double, 2, Eigen::Dynamic> by_parameters;  ///< (2, n) [Pa per unit of the parameter]
};
StressByParameters stress_by_parameters(const MaterialModel& model, const std::vector<double>& parameters,
                                        const Stretches& stretches);

/// The Hessian of W in the logarithmic stretches [Pa]: H_ij = d(tau_i)/d(ln l_j) with Kirchhoff stress tau_i = l_i P_i.
/// Drucker's stability of an incompressible sheet in plane stress asks that it be positive definite.
Eigen::Matrix2d logarithmic_stiffness(const Material& material, const Stretches& stretches);

/// The pressure [Pa] that holds a sheet of rest thickness h at its pole, of radius of curvature r [m] and stretch L:
/// membrane tension p r/2 = h P(L)/L.
double pole_pressure(const Material& material, double thickness, double radius, double stretch);

/// And the nominal stress [Pa] from what is measured there: P = p r L/(2 h).
double pole_stress(double pressure, double thickness, double radius, double stretch);

}  // namespace softform
