#include "softform/fitting/membrane_test_curve.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <fmt/format.h>

#include "softform/core/error.hpp"
#include "softform/fitting/circular_membrane.hpp"

namespace softform {
namespace {

double interpolate(const Vec& x, const Vec& y, double wanted)
{
  const auto above =
      std::clamp<Eigen::Index>(std::upper_bound(x.begin(), x.end(), wanted) - x.begin(), 1, x.size() - 1);
  const double share = (wanted - x[above - 1]) / (x[above] - x[above - 1]);
  return (1 - share) * y[above - 1] + share * y[above];
}

}  // namespace

double InflationCurve::pressure_at_extension(double wanted) const { return interpolate(extension, pressure, wanted); }
double InflationCurve::pressure_at_volume(double wanted) const { return interpolate(volume, pressure, wanted); }
double InflationCurve::extension_at_volume(double wanted) const { return interpolate(volume, extension, wanted); }

InflationCurve inflation_curve(const Material& material, double thickness, double radius, double largest_volume)
{
  std::vector<InflatedCircle> states;
  constexpr double first = 1.01, step = 0.01;
  for (double stretch = first; states.empty() || states.back().volume < largest_volume; stretch += step)
    states.push_back(inflated_circle(material, thickness, radius, stretch));
  const auto count = static_cast<Eigen::Index>(states.size());
  InflationCurve curve{Vec(count), Vec(count), Vec(count)};
  for (Eigen::Index k = 0; k < count; ++k) {
    const InflatedCircle& state = states[static_cast<std::size_t>(k)];
    curve.volume[k] = state.volume;
    curve.extension[k] = std::sqrt(state.area / (std::numbers::pi * radius * radius));
    curve.pressure[k] = state.pressure;
  }
  return curve;
}

std::array<double, 4> three_regimes(const InflationCurve& measured, double contrast)
{
  const Eigen::Index n = measured.extension.size();
  if (n < 6) throw InputError(fmt::format("{} states are too few to tell three regimes: measure 6 or more", n));
  const auto difference = [n](const Vec& v) -> Vec { return v.tail(n - 1) - v.head(n - 1); };
  const Vec stiffness = difference(measured.pressure).cwiseQuotient(difference(measured.extension));
  const double least = stiffness.minCoeff();
  const double first = stiffness[0], last = stiffness[n - 2];
  if (!(std::min(first, last) > std::max(0.0, contrast * least)))
    throw InputError("the measured curve has no three regimes: its stiffness does not fall and rise again");
  Eigen::Index end_of_first = 0, begin_of_third = n - 1;
  while (stiffness[end_of_first] > (first + least) / 2) ++end_of_first;
  while (stiffness[begin_of_third - 1] > (last + least) / 2) --begin_of_third;
  return {measured.extension[0], measured.extension[end_of_first], measured.extension[begin_of_third],
          measured.extension[n - 1]};
}

double mean_stiffness(const InflationCurve& curve, double from, double to)
{
  return (curve.pressure_at_extension(to) - curve.pressure_at_extension(from)) / (to - from);
}

std::array<double, 3> regime_stiffness(const InflationCurve& curve, const std::array<double, 4>& bounds)
{
  return {mean_stiffness(curve, bounds[0], bounds[1]), mean_stiffness(curve, bounds[1], bounds[2]),
          mean_stiffness(curve, bounds[2], bounds[3])};
}

}  // namespace softform
