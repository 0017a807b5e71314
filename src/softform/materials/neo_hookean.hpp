#pragma once

#include <vector>

#include "softform/materials/invariant_density.hpp"
#include "softform/materials/material_model.hpp"

namespace softform {

/// Neo-Hookean (A.4), incompressible: Psi = mu/2 (I1 - 3), mu in Pa.
template <class Scalar>
struct NeoHookean {
  Scalar mu;

  static NeoHookean from(const std::vector<Scalar>& parameters) { return {parameters[0]}; }

  Scalar shear_modulus() const { return mu; }

  BasicMembraneDensity<Scalar> density(double t, double d, Order order) const
  {
    const InvariantTerm<Scalar> f{mu * ((first_invariant(t, d) - 3) / 2), mu / 2.0, Scalar(0), Scalar(0)};
    return invariant_density(f, InvariantTerm<Scalar>{}, t, d, order);
  }
};

/// Throws InputError unless mu > 0.
void check_parameters(const NeoHookean<double>& model);

MaterialModel neo_hookean_model();

}  // namespace softform
