#pragma once

#include <memory>

#include "softform/materials/material.hpp"

namespace softform {

/// A strain-energy density of a solid and its derivatives in two invariants of the deformation gradient, I = tr F^t F
/// and J = det F. All in Pa (J and I are dimensionless). Entries beyond the order asked for are zero.
struct SolidDensity {
  double psi = 0;
  double psi_I = 0, psi_J = 0;
  double psi_II = 0, psi_IJ = 0, psi_JJ = 0;
  double psi_III = 0, psi_IIJ = 0, psi_IJJ = 0, psi_JJJ = 0;
};

/// a f + b g, entry by entry.
SolidDensity weighted_sum(double a, const SolidDensity& f, double b, const SolidDensity& g);

/// An isotropic material of a solid body, in space or in plane stress, point-wise: it knows no element.
class SolidMaterial {
 public:
  virtual ~SolidMaterial() = default;

  /// psi(I, J) and derivatives up to `order`. Outside the domain psi is +infinity, the derivatives are zero.
  virtual SolidDensity density(double I, double J, Order order) const = 0;

  /// Shear modulus at rest [Pa].
  virtual double shear_modulus() const = 0;
};

/// The two neo-Hookean densities of the thesis in space, both with shear modulus G and bulk modulus kappa at rest.
enum class NeoHookeanForm {
  /// (5.1) made stress-free at rest, mu = G/2:  mu (I - 3) - 2 mu (J - 1) + k/2 (J - 1)^2,  k = kappa + 2 mu/3. Defined
  /// for inverted elements too, so that Newton's method passes through them.
  StressFree,
  /// (A.4):  G/2 (J^-2/3 I - 3) + kappa/2 (J - 1)^2, for J > 0.
  Isochoric,
};

/// Throws InputError unless both moduli [Pa] are positive.
std::shared_ptr<const SolidMaterial> neo_hookean_solid(double shear_modulus, double bulk_modulus,
                                                       NeoHookeanForm form = NeoHookeanForm::StressFree);

/// kappa of an elastic material with shear modulus G and Poisson's ratio nu in (0, 1/2). Throws InputError otherwise.
double bulk_modulus(double shear_modulus, double poisson_ratio);

/// An incompressible material in a sheet that is free to change its thickness, by the kinematics of (4.1): t = I and
/// d = J^2. For the neo-Hookean material G/2 (I + 1/J^2 - 3). +infinity for J <= 0, where d could not tell.
std::shared_ptr<const SolidMaterial> plane_stress(std::shared_ptr<const Material> material);

}  // namespace softform
