#include "softform/materials/tension_field.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "softform/core/error.hpp"
#include "softform/core/jet.hpp"

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

// What the formula needs to know before it differentiates: where it is.
struct Place {
  SquaredStretches stretches;
  double tension_1, tension_2;  // the arguments of the two brackets

  explicit Place(double t, double d) : stretches(SquaredStretches::of(t, d))
  {
    const double s = std::sqrt(stretches.lambda_1);
    tension_1 = s - 1;
    tension_2 = stretches.lambda_2 - 1 / s;
  }
  double difference() const { return stretches.lambda_1 - stretches.lambda_2; }
};

// The two bracketed terms with an eigenvalue decomposition; `square` is one of the two functions above.
// Precondition: lambda_1 > lambda_2, tension_1 > 0.
template <class Number, class Square>
Number bracket_sum(const Place& place, double smoothing, const Number& t, const Number& d, const Square& square)
{
  const Number difference = sqrt(t * t - 4 * d), e = smoothing * difference;
  const Number lambda_1 = 0.5 * (t + difference), lambda_2 = d / lambda_1, s = sqrt(lambda_1);
  Number sum = square(s - 1, e) * (s + 2) / s;
  if (place.tension_2 > 0) sum = sum + square(lambda_2 - 1 / s, e) / lambda_2;
  return sum;
}

// (6.6) over kappa.
template <class Number>
Number relaxed_energy(double smoothing, double t_value, double d_value)
{
  const Place place(t_value, d_value);
  const Number t = Number::first(t_value), d = Number::second(d_value);
  const double e = smoothing * place.difference();
  // Both brackets in full: (B.20), which needs no eigenvalues and so passes through equal stretches.
  if (place.tension_1 >= e && place.tension_2 >= e) return t + 1 / d - 3;
  if (place.tension_1 <= 0) return 0;  // NaN goes on
  return bracket_sum(place, smoothing, t, d,
                     [](const Number& z, const Number& width) { return smoothed_square(z, width); });
}

// Its derivative in the smoothing.
template <class Number>
Number relaxed_energy_by_smoothing(double smoothing, double t_value, double d_value)
{
  const Place place(t_value, d_value);
  if (place.tension_1 <= 0 || place.difference() <= 0) return 0;
  const Number t = Number::first(t_value), d = Number::second(d_value);
  return sqrt(t * t - 4 * d) * bracket_sum(place, smoothing, t, d, [](const Number& z, const Number& width) {
           return smoothed_square_by_width(z, width);
         });
}

template <class Number>
MembraneDensity density_of(const Number& psi)
{
  return {psi.derivative(0, 0), psi.derivative(1, 0), psi.derivative(0, 1), psi.derivative(2, 0), psi.derivative(1, 1),
          psi.derivative(0, 2), psi.derivative(3, 0), psi.derivative(2, 1), psi.derivative(1, 2), psi.derivative(0, 3)};
}

// energy: a function of (Jet's tag) that returns the energy with derivatives up to the order.
template <class Energy>
MembraneDensity with_derivatives(Order order, const Energy& energy)
{
  switch (order) {
    case Order::Value: return density_of(energy(Jet<0>()));
    case Order::Gradient: return density_of(energy(Jet<1>()));
    case Order::Hessian: return density_of(energy(Jet<2>()));
    case Order::Third: return density_of(energy(Jet<3>()));
  }
  return {};
}

}  // namespace

SquaredStretches SquaredStretches::of(double t, double d)
{
  const double lambda_1 = 0.5 * (t + std::sqrt(std::max(t * t - 4 * d, 0.0)));
  return {lambda_1, std::min(lambda_1, std::max(d, 0.0) / lambda_1)};
}

TensionState tension_state(double t, double d)
{
  const Place place(t, d);
  if (!(place.tension_1 > 0)) return TensionState::Slack;
  return place.tension_2 > 0 ? TensionState::Taut : TensionState::Wrinkled;
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
    using Number = decltype(jet);
    return kappa_ * (relaxed_energy<Number>(smoothing_, t, d) + residual_ * (Number::first(t) - 2));
  });
}

MembraneDensity TensionField::density_derivative(int parameter, double t, double d, Order order) const
{
  return with_derivatives(order, [&](auto jet) -> decltype(jet) {
    using Number = decltype(jet);
    if (parameter == 0) return relaxed_energy<Number>(smoothing_, t, d) + residual_ * (Number::first(t) - 2);
    if (parameter == 1) return kappa_ * relaxed_energy_by_smoothing<Number>(smoothing_, t, d);
    return kappa_ * (Number::first(t) - 2);
  });
}

}  // namespace softform
