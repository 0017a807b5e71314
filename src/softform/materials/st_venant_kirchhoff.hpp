#pragma once

#include <vector>

#include "softform/materials/invariant_density.hpp"
#include "softform/materials/material_model.hpp"

namespace softform {

/// St. Venant-Kirchhoff (A.3) on an incompressible C:
///     Psi = lambda/2 (tr E)^2 + mu tr(E^2),   E = (C - I)/2,
/// with tr E = (I1 - 3)/2 and tr(E^2) = (I1^2 - 2 I2 - 2 I1 + 3)/4. lambda and mu are in Pa.
template <class Scalar>
struct StVenantKirchhoff {
  Scalar lambda, mu;

  static StVenantKirchhoff from(const std::vector<Scalar>& parameters) { return {parameters[0], parameters[1]}; }

  Scalar shear_modulus() const { return mu; }

  BasicMembraneDensity<Scalar> density(double t, double d, Order order) const
  {
    const double I1 = first_invariant(t, d), I2 = second_invariant(t, d), x = I1 - 3;
    const InvariantTerm<Scalar> f{lambda * (x * x / 8) + mu * (x * (I1 + 1) / 4),
                                  lambda * (x / 4) + mu * ((I1 - 1) / 2), lambda / 4.0 + mu / 2.0, Scalar(0)};
    const InvariantTerm<Scalar> g{mu * ((3 - I2) / 2), mu * -0.5, Scalar(0), Scalar(0)};
    return invariant_density(f, g, t, d, order);
  }
};

/// Throws InputError unless mu > 0 and 3 lambda + 2 mu > 0: the energy must grow with every strain.
void check_parameters(const StVenantKirchhoff<double>& model);

MaterialModel st_venant_kirchhoff_model();

}  // namespace softform
