#include "softform/materials/tension_field.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "softform/core/error.hpp"
#include "softform/materials/strain_formula.hpp"

namespace softform {
namespace {

// [z]^2 smoothed over 0 < z < e. Precondition: z > 0.
template <class Number>
Number smoothed_square(const Number& z, const Number& e)
{
  if (z.value() >= e.value()) return z * z;
  const Number u = z / e;
  return z * z * u * (3 - 3 * u + u * u);
}

// Its derivative in e.
template <class Number>
Number smoothed_square_by_width(const Number& z, const Number& e)
{
  if (z.value() >= e.value()) return 0;
  const Number u = z / e;
  return -3 * z * u * u * (1 - u) * (1 - u);
}

// The larger eigenvalue of C~ - 1.
template <class Number>
Number larger_strain(const Number& trace, const Number& difference)
{
  return 0.5 * (trace + difference);
}

// s - 1 and lambda_2 - 1/s, the arguments of the two brackets, from the squared stretches less 1: near the rest state
// the stress is made of what is left of them there.
template <class Number>
struct Tensions {
  Number s, first, second;

  Tensions(const Number& strain_1, const Number& strain_2)
      : s(sqrt(1 + strain_1)), first(strain_1 / (1 + s)), second(strain_2 + first / s)
  {}
};

// What the formula needs to know before it differentiates: where it is.
struct Place {
  double difference, first, second;  // lambda_1 - lambda_2, and the tensions

  Place(double trace, double determinant)
  {
    const double a = trace;
    difference = std::sqrt(std::max(a * a - 4 * determinant, 0.0));
    const double strain_1 = std::max(larger_strain(a, difference), -1.0);  // NaN goes on
    const Tensions<double> tensions(strain_1, a - strain_1);
    first = tensions.first;
    second = tensions.second;
  }
};

// The two bracketed terms with an eigenvalue decomposition; `square` is one of the two functions above.
// Precondition: lambda_1 > lambda_2, first tension > 0.
template <class Number, class Square>
Number bracket_sum(const Place& place, double smoothing, const Strain<Number>& strain, const Square& square)
{
  const Number difference = sqrt(strain.trace * strain.trace - 4 * strain.determinant), e = smoothing * difference;
  const Number strain_1 = larger_strain(strain.trace, difference), strain_2 = strain.trace - strain_1;
  const Tensions<Number> tensions(strain_1, strain_2);
  Number sum = square(tensions.first, e) * (tensions.s + 2) / tensions.s;
  if (place.second > 0) sum = sum + square(tensions.second, e) / (1 + strain_2);
  return sum;
}

// (6.6) over kappa.
template <class Number>
Number relaxed_energy(double smoothing, const Strain<Number>& strain)
{
  const Place place(strain.trace.value(), strain.determinant.value());
  const double e = smoothing * place.difference;
  // Both brackets in full need no eigenvalues and so pass through equal stretches.
  if (place.first >= e && place.second >= e) return neo_hookean_energy(strain);
  if (place.first <= 0) return 0;  // NaN goes on
  return bracket_sum(place, smoothing, strain,
                     [](const Number& z, const Number& width) { return smoothed_square(z, width); });
}

template <class Number>
Number energy_over_kappa(double smoothing, double residual, const Strain<Number>& strain)
{
  return relaxed_energy(smoothing, strain) + residual * strain.trace;
}

// The derivative of (6.6) over kappa in the smoothing.
template <class Number>
Number relaxed_energy_by_smoothing(double smoothing, const Strain<Number>& strain)
{
  const Place place(strain.trace.value(), strain.determinant.value());
  if (place.first <= 0 || place.difference <= 0) return 0;
  return sqrt(strain.trace * strain.trace - 4 * strain.determinant) *
         bracket_sum(place, smoothing, strain,
                     [](const Number& z, const Number& width) { return smoothed_square_by_width(z, width); });
}

}  // namespace

SquaredStretches SquaredStretches::of(double t, double d)
{
  const double lambda_1 = 0.5 * (t + std::sqrt(std::max(t * t - 4 * d, 0.0)));
  return {lambda_1, std::min(lambda_1, std::max(d, 0.0) / lambda_1)};
}

TensionState tension_state(double t, double d)
{
  const Place place(t - 2, d - t + 1);
  if (!(place.first > 0)) return TensionState::Slack;
  return place.second > 0 ? TensionState::Taut : TensionState::Wrinkled;
}

TensionField::TensionField(double kappa, double smoothing, double residual)
    : kappa_(kappa), smoothing_(smoothing), residual_(residual)
{
  if (!(kappa > 0) || !std::isfinite(kappa))
    throw InputError(fmt::format("tension_field: kappa = {} Pa: it must be positive", kappa));
  if (!(smoothing >= 0) || !std::isfinite(smoothing))
    throw InputError(fmt::format("tension_field: smoothing = {}: it must not be negative", smoothing));
  if (!(residual >= 0) || !std::isfinite(residual))
    throw InputError(fmt::format("tension_field: residual = {}: it must not be negative", residual));
}

std::vector<MaterialParameter> TensionField::parameters() const
{
  return {{"kappa", kappa_, "Pa"}, {"smoothing", smoothing_, "1"}, {"residual", residual_, "1"}};
}

MembraneDensity TensionField::density(double t, double d, Order order) const
{
  return with_derivatives(order, [&](auto jet) {
    return kappa_ * energy_over_kappa(smoothing_, residual_, strain_of<decltype(jet)>(t, d));
  });
}

MembraneDensity TensionField::density_of_strain(const CauchyGreenInvariants& C, Order order) const
{
  return with_derivatives(order, [&](auto jet) {
    return kappa_ * energy_over_kappa(smoothing_, residual_, strain_itself<decltype(jet)>(C));
  });
}

MembraneDensity TensionField::density_derivative(int parameter, double t, double d, Order order) const
{
  return with_derivatives(order, [&](auto jet) -> decltype(jet) {
    const auto strain = strain_of<decltype(jet)>(t, d);
    if (parameter == 0) return energy_over_kappa(smoothing_, residual_, strain);
    if (parameter == 1) return kappa_ * relaxed_energy_by_smoothing(smoothing_, strain);
    return kappa_ * strain.trace;
  });
}

}  // namespace softform
