#pragma once

#include <vector>

#include "softform/materials/invariant_density.hpp"
#include "softform/materials/material_model.hpp"

namespace softform {

/// Mooney-Rivlin (A.5), incompressible: Psi = mu_1/2 (I1 - 3) + mu_2/2 (I2 - 3), mu_1 and mu_2 in Pa.
template <class Scalar>
struct MooneyRivlin {
  Scalar mu_1, mu_2;

  static MooneyRivlin from(const std::vector<Scalar>& parameters) { return {parameters[0], parameters[1]}; }

  Scalar shear_modulus() const { return mu_1 + mu_2; }

  BasicMembraneDensity<Scalar> density(double t, double d, Order order) const
  {
    const InvariantTerm<Scalar> f{mu_1 * ((first_invariant(t, d) - 3) / 2), mu_1 / 2.0, Scalar(0), Scalar(0)};
    const InvariantTerm<Scalar> g{mu_2 * ((second_invariant(t, d) - 3) / 2), mu_2 / 2.0, Scalar(0), Scalar(0)};
    return invariant_density(f, g, t, d, order);
  }
};

/// Throws InputError unless mu_1 >= 0, mu_2 >= 0 and mu_1 + mu_2 > 0: otherwise the energy falls without bound.
void check_parameters(const MooneyRivlin<double>& model);

MaterialModel mooney_rivlin_model();

}  // namespace softform
