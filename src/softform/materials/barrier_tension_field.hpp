#pragma once

#include "softform/materials/material.hpp"

namespace softform {

/// The relaxed energy (6.6) without its jumps. Relaxed, a membrane may take up width in wrinkles, W >= 0, and chooses
/// what costs least (Pipkin 1986):
///     psi(C~) = min over W >= 0 of Psi(C~ + W),   Psi the neo-Hookean energy (6.3).
/// Here a logarithmic barrier keeps W positive, as in an interior point method:
///     psi(C~) = min over W > 0 of Psi(C~ + W) - nu kappa log det W  + residual kappa (t - 2).
/// The minimum has N W = nu with N = dPsi/dC~ / kappa, so that
///   - psi is an analytic function of C~ everywhere, at equal stretches and in the rest state too, with derivatives of
///     all orders;
///   - the stress 2 kappa N is positive, whatever the deformation: nu / w in a wrinkle that takes up w;
///   - where the membrane pulls, C~ is short of what the stress asks for by nu / N. Wrinkles come and go over strains
///     of sqrt(nu), where (6.6) changes its kind at once.
/// With nu to zero it is (6.6), which the objective of an inverse design meets at its kinks: the best panels are those
/// whose wrinkles are about to vanish.
///
/// The residual stiffness is that of TensionField.
class BarrierTensionField final : public Material {
 public:
  /// kappa [Pa]; barrier nu, dimensionless. Throws InputError unless both are positive and residual >= 0.
  explicit BarrierTensionField(double kappa, double barrier, double residual = 0);

  std::string model() const override { return "barrier_tension_field"; }
  std::vector<MaterialParameter> parameters() const override;
  /// Finite for every deformation, flat triangles (d = 0) included.
  MembraneDensity density(double t, double d, Order order) const override;
  MembraneDensity density_of_strain(const CauchyGreenInvariants& C, Order order) const override;
  MembraneDensity density_derivative(int parameter, double t, double d, Order order) const override;
  double shear_modulus() const override { return 2 * kappa_; }

  double kappa() const { return kappa_; }
  double barrier() const { return barrier_; }
  double residual() const { return residual_; }

 private:
  double kappa_, barrier_, residual_;
};

}  // namespace softform
