#pragma once

#include "softform/materials/material.hpp"

namespace softform {

/// The pressure [Pa] in a spherical balloon of rest radius R and thickness h [m] at the stretch L = r/R,
///     p = (h / R) W'(L) / L^2,   W(L) = Psi(lambda_1 = lambda_2 = L),
/// which is 4 (h/R) (1/L - 1/L^7) (dPsi/dI1 + L^2 dPsi/dI2): dE/dV of a membrane of energy 4 pi R^2 h W.
double spherical_balloon_pressure(const Material& material, double thickness, double radius, double stretch);

}  // namespace softform
