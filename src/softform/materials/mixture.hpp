#pragma once

#include <memory>

#include "softform/materials/solid_material.hpp"

namespace softform {

/// On which path an element's stiffness goes from soft (rho = 0) to stiff (rho = 1). Layouts of 0 and 1 have the same
/// energy on every path; what differs is how a gradient sees the way between them.
enum class MixturePath {
  Linear,     ///< s = rho, (5.16): at a contrast of 1000 nearly all of the change lies below rho = 0.05
  Simp,       ///< s = rho^3 (Bendsoe and Sigmund 1999)
  Geometric,  ///< s = (c^rho - 1)/(c - 1), c the contrast: equal steps of rho are equal factors of stiffness
};

/// Two materials and how an element is made of both: psi = (1 - s(rho)) psi_soft + s(rho) psi_stiff, (5.16) for s =
/// rho. The mass density is mixed linearly.
class Mixture {
 public:
  /// One material, whatever rho.
  explicit Mixture(std::shared_ptr<const SolidMaterial> material, double mass_density = 0);
  /// mass densities: [kg/m^3]. Throws InputError unless the contrast of the shear moduli is at least 1.
  Mixture(std::shared_ptr<const SolidMaterial> soft, std::shared_ptr<const SolidMaterial> stiff, MixturePath path,
          double soft_mass_density = 0, double stiff_mass_density = 0);

  const SolidMaterial& soft() const { return *soft_; }
  const SolidMaterial& stiff() const { return *stiff_; }
  /// Ratio of the shear moduli, at least 1.
  double contrast() const { return contrast_; }
  MixturePath path() const { return path_; }

  /// s(rho), s'(rho), s''(rho).
  struct Weight {
    double value, first, second;
  };
  Weight weight(double rho) const;

  SolidDensity density(double rho, double I, double J, Order order) const;
  /// d psi/d s: stiff minus soft.
  SolidDensity difference(double I, double J, Order order) const;

  /// [kg/m^3] and its derivative.
  double mass_density(double rho) const { return soft_mass_ + rho * (stiff_mass_ - soft_mass_); }
  double mass_density_derivative() const { return stiff_mass_ - soft_mass_; }

 private:
  std::shared_ptr<const SolidMaterial> soft_, stiff_;
  MixturePath path_ = MixturePath::Linear;
  double contrast_ = 1;
  double soft_mass_ = 0, stiff_mass_ = 0;
};

}  // namespace softform
