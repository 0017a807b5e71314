#include "softform/materials/mixture.hpp"

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "softform/core/error.hpp"

namespace softform {

Mixture::Mixture(std::shared_ptr<const SolidMaterial> material, double mass_density)
    : soft_(material), stiff_(std::move(material)), soft_mass_(mass_density), stiff_mass_(mass_density)
{}

Mixture::Mixture(std::shared_ptr<const SolidMaterial> soft, std::shared_ptr<const SolidMaterial> stiff,
                 MixturePath path, double soft_mass_density, double stiff_mass_density)
    : soft_(std::move(soft)),
      stiff_(std::move(stiff)),
      path_(path),
      contrast_(stiff_->shear_modulus() / soft_->shear_modulus()),
      soft_mass_(soft_mass_density),
      stiff_mass_(stiff_mass_density)
{
  if (!(contrast_ >= 1) || !std::isfinite(contrast_))
    throw InputError(
        fmt::format("the stiff material has {:g} times the shear modulus of the soft one: it must have at "
                    "least as much; exchange the two",
                    contrast_));
}

Mixture::Weight Mixture::weight(double rho) const
{
  // c^rho - 1 over c - 1 has the limit rho as c goes to 1.
  const bool is_linear = path_ == MixturePath::Linear || contrast_ - 1 < 1e-9;
  if (is_linear) return {rho, 1, 0};
  if (path_ == MixturePath::Simp) return {rho * rho * rho, 3 * rho * rho, 6 * rho};
  const double log_c = std::log(contrast_), power = std::exp(rho * log_c) / (contrast_ - 1);
  return {std::expm1(rho * log_c) / (contrast_ - 1), log_c * power, log_c * log_c * power};
}

SolidDensity Mixture::density(double rho, double I, double J, Order order) const
{
  const double s = weight(rho).value;
  // The pure materials alone, not zero times the other, which may be infinite.
  if (s == 0 || soft_ == stiff_) return soft_->density(I, J, order);
  if (s == 1) return stiff_->density(I, J, order);
  return weighted_sum(1 - s, soft_->density(I, J, order), s, stiff_->density(I, J, order));
}

SolidDensity Mixture::difference(double I, double J, Order order) const
{
  return weighted_sum(-1, soft_->density(I, J, order), 1, stiff_->density(I, J, order));
}

}  // namespace softform
