#include "softform/materials/solid_material.hpp"

#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "softform/core/error.hpp"

namespace softform {
namespace {

SolidDensity outside()
{
  SolidDensity density;
  density.psi = std::numeric_limits<double>::infinity();
  return density;
}

class StressFreeNeoHookean final : public SolidMaterial {
 public:
  StressFreeNeoHookean(double shear_modulus, double bulk_modulus)
      : mu_(shear_modulus / 2), k_(bulk_modulus + 2 * mu_ / 3)
  {}

  SolidDensity density(double I, double J, Order) const override
  {
    SolidDensity density;
    density.psi = mu_ * (I - 3) - 2 * mu_ * (J - 1) + k_ / 2 * (J - 1) * (J - 1);
    density.psi_I = mu_;
    density.psi_J = -2 * mu_ + k_ * (J - 1);
    density.psi_JJ = k_;
    return density;
  }

  double shear_modulus() const override { return 2 * mu_; }

 private:
  double mu_, k_;
};

class IsochoricNeoHookean final : public SolidMaterial {
 public:
  IsochoricNeoHookean(double shear_modulus, double bulk_modulus) : G_(shear_modulus), kappa_(bulk_modulus) {}

  SolidDensity density(double I, double J, Order) const override
  {
    if (!(J > 0)) return outside();
    const double u = G_ / 2 * std::pow(J, -2.0 / 3);
    SolidDensity density;
    density.psi = u * I - 1.5 * G_ + kappa_ / 2 * (J - 1) * (J - 1);
    density.psi_I = u;
    density.psi_J = -2.0 / 3 * u * I / J + kappa_ * (J - 1);
    density.psi_IJ = -2.0 / 3 * u / J;
    density.psi_JJ = 10.0 / 9 * u * I / (J * J) + kappa_;
    density.psi_IJJ = 10.0 / 9 * u / (J * J);
    density.psi_JJJ = -80.0 / 27 * u * I / (J * J * J);
    return density;
  }

  double shear_modulus() const override { return G_; }

 private:
  double G_, kappa_;
};

class PlaneStress final : public SolidMaterial {
 public:
  explicit PlaneStress(std::shared_ptr<const Material> material) : material_(std::move(material)) {}

  SolidDensity density(double I, double J, Order order) const override
  {
    if (!(J > 0)) return outside();
    const MembraneDensity f = material_->density(I, J * J, order);
    SolidDensity density;
    density.psi = f.psi;
    density.psi_I = f.psi_t;
    density.psi_J = 2 * J * f.psi_d;
    density.psi_II = f.psi_tt;
    density.psi_IJ = 2 * J * f.psi_td;
    density.psi_JJ = 2 * f.psi_d + 4 * J * J * f.psi_dd;
    density.psi_III = f.psi_ttt;
    density.psi_IIJ = 2 * J * f.psi_ttd;
    density.psi_IJJ = 2 * f.psi_td + 4 * J * J * f.psi_tdd;
    density.psi_JJJ = 12 * J * f.psi_dd + 8 * J * J * J * f.psi_ddd;
    return density;
  }

  double shear_modulus() const override { return material_->shear_modulus(); }

 private:
  std::shared_ptr<const Material> material_;
};

}  // namespace

SolidDensity weighted_sum(double a, const SolidDensity& f, double b, const SolidDensity& g)
{
  return {a * f.psi + b * g.psi,         a * f.psi_I + b * g.psi_I,     a * f.psi_J + b * g.psi_J,
          a * f.psi_II + b * g.psi_II,   a * f.psi_IJ + b * g.psi_IJ,   a * f.psi_JJ + b * g.psi_JJ,
          a * f.psi_III + b * g.psi_III, a * f.psi_IIJ + b * g.psi_IIJ, a * f.psi_IJJ + b * g.psi_IJJ,
          a * f.psi_JJJ + b * g.psi_JJJ};
}

std::shared_ptr<const SolidMaterial> neo_hookean_solid(double shear_modulus, double bulk_modulus, NeoHookeanForm form)
{
  if (!(shear_modulus > 0) || !(bulk_modulus > 0))
    throw InputError(fmt::format("solid: shear modulus {:g} Pa and bulk modulus {:g} Pa must both be positive",
                                 shear_modulus, bulk_modulus));
  if (form == NeoHookeanForm::StressFree) return std::make_shared<StressFreeNeoHookean>(shear_modulus, bulk_modulus);
  return std::make_shared<IsochoricNeoHookean>(shear_modulus, bulk_modulus);
}

double bulk_modulus(double shear_modulus, double poisson_ratio)
{
  if (!(poisson_ratio > 0 && poisson_ratio < 0.5))
    throw InputError(
        fmt::format("Poisson's ratio {:g} must lie between 0 and 0.5; incompressible solids need another "
                    "element",
                    poisson_ratio));
  return shear_modulus * 2 * (1 + poisson_ratio) / (3 * (1 - 2 * poisson_ratio));
}

std::shared_ptr<const SolidMaterial> plane_stress(std::shared_ptr<const Material> material)
{
  return std::make_shared<PlaneStress>(std::move(material));
}

}  // namespace softform
