#pragma once

#include "softform/materials/material.hpp"

namespace softform {

/// What a membrane does at a point (6.4): neither direction pulls, one does, or both.
enum class TensionState { Slack, Wrinkled, Taut };

/// The squared principal stretches of (6.1), the eigenvalues of C~, from its trace and determinant.
/// lambda_1 >= lambda_2; round-off is cut at equal stretches.
struct SquaredStretches {
  double lambda_1, lambda_2;

  static SquaredStretches of(double t, double d);
};

/// The relaxed energy of tension field theory (6.6): neo-Hookean (6.3) where both directions pull, its minimum over the
/// second stretch where the membrane wrinkles, zero where it is slack. With s = sqrt(lambda_1)
///     psi = kappa ([s - 1]^2 (s + 2)/s + [lambda_2 - 1/s]^2 / lambda_2) + residual kappa (t - 2),
/// brackets being zero for negative arguments.
///
/// (6.6) has jumps in its second derivatives. With smoothing delta > 0 both [z]^2 become e^2 u^3 (3 - 3u + u^2) for
/// 0 < u = z/e < 1, e = delta (lambda_1 - lambda_2): twice continuously differentiable but at the rest state itself,
/// and still an energy, which the smoothing (6.12) of the derivatives is not. It softens wrinkled regions whose tensile
/// strain is below e: a static solve does without.
///
/// The residual stiffness, a term tr C~, keeps slack directions definite. It pulls like a surface tension
/// 2 residual kappa h: the membrane's stress resultants are off by that much.
///
/// The neo-Hookean energy alone is NeoHookean with mu = 2 kappa; Young's modulus is 6 kappa.
class TensionField final : public Material {
 public:
  /// kappa [Pa]. Throws InputError unless kappa > 0, smoothing >= 0 and residual >= 0.
  explicit TensionField(double kappa, double smoothing = 0, double residual = 0);

  std::string model() const override { return "tension_field"; }
  std::vector<MaterialParameter> parameters() const override;
  /// Finite for every deformation, flat triangles (d = 0) included. Third derivatives jump between branches.
  MembraneDensity density(double t, double d, Order order) const override;
  MembraneDensity density_of_strain(const CauchyGreenInvariants& C, Order order) const override;
  MembraneDensity density_derivative(int parameter, double t, double d, Order order) const override;
  double shear_modulus() const override { return 2 * kappa_; }

  double kappa() const { return kappa_; }
  double smoothing() const { return smoothing_; }
  double residual() const { return residual_; }

 private:
  double kappa_, smoothing_, residual_;
};

/// The branch of (6.4) without smoothing.
TensionState tension_state(double t, double d);

}  // namespace softform
