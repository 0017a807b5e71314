#include "softform/fitting/circular_membrane.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include <boost/math/tools/roots.hpp>
#include <boost/numeric/odeint.hpp>
#include <fmt/format.h>

#include "softform/core/error.hpp"

namespace softform {
namespace {

// The derivatives in l_1 and l_2 of W(l_1, l_2) = Psi(l_1^2 + l_2^2, l_1^2 l_2^2), over the shear modulus.
struct StretchDerivatives {
  double W_1, W_2, W_11, W_12;
};

StretchDerivatives stretch_derivatives(const Material& material, double l_1, double l_2)
{
  const MembraneDensity psi = material.density(l_1 * l_1 + l_2 * l_2, l_1 * l_1 * l_2 * l_2, Order::Hessian);
  const double t_1 = 2 * l_1, t_2 = 2 * l_2, d_1 = 2 * l_1 * l_2 * l_2, d_2 = 2 * l_1 * l_1 * l_2;
  const double mu = material.shear_modulus();
  const double W_1 = psi.psi_t * t_1 + psi.psi_d * d_1, W_2 = psi.psi_t * t_2 + psi.psi_d * d_2;
  const double W_11 = psi.psi_tt * t_1 * t_1 + 2 * psi.psi_td * t_1 * d_1 + psi.psi_dd * d_1 * d_1 + psi.psi_t * 2 +
                      psi.psi_d * 2 * l_2 * l_2;
  const double W_12 = psi.psi_tt * t_1 * t_2 + psi.psi_td * (t_1 * d_2 + t_2 * d_1) + psi.psi_dd * d_1 * d_2 +
                      psi.psi_d * 4 * l_1 * l_2;
  return {W_1 / mu, W_2 / mu, W_11 / mu, W_12 / mu};
}

// Meridional and hoop stretch, slope of the meridian below the horizontal, depth below the pole, volume and area so
// far.
using State = std::array<double, 6>;

// Equilibrium along the meridian, in the rest radius R; lengths in units of mu h/p, stresses in units of mu:
//     d(R W_1)/dR = W_2 cos(theta),   p = N_1 kappa_1 + N_2 kappa_2   with N_1 = W_1/l_2, N_2 = W_2/l_1.
State meridian(const Material& material, const State& state, double R)
{
  const auto& [l_1, l_2, theta, depth, volume, area] = state;
  const auto [W_1, W_2, W_11, W_12] = stretch_derivatives(material, l_1, l_2);
  const double r = R * l_2;
  State slope;
  slope[1] = (l_1 * std::cos(theta) - l_2) / R;
  slope[0] = ((W_2 * std::cos(theta) - W_1) / R - W_12 * slope[1]) / W_11;
  slope[2] = l_1 * (1 - W_2 / l_1 * std::sin(theta) / r) * l_2 / W_1;
  slope[3] = l_1 * std::sin(theta);
  slope[4] = std::numbers::pi * r * r * slope[3];
  slope[5] = 2 * std::numbers::pi * r * l_1;
  return slope;
}

}  // namespace

// The equations have no length of their own: integrating from the pole at p = 1 until the hoop stretch is 1, where the
// clamp must be, gives the radius in units of mu h/p and with it the pressure, without any shooting.
InflatedCircle inflated_circle(const Material& material, double thickness, double radius, double pole_stretch)
{
  if (!(pole_stretch > 1))
    throw InputError(fmt::format("an inflated membrane of pole stretch {}: it must exceed 1", pole_stretch));
  namespace odeint = boost::numeric::odeint;
  auto stepper = odeint::make_dense_output(1e-12, 1e-12, odeint::runge_kutta_dopri5<State>());
  const double start = 1e-5;  // the pole itself is a removable singularity; the error is of the order of its square
  const double curvature = pole_stretch / (2 * stretch_derivatives(material, pole_stretch, pole_stretch).W_1);
  stepper.initialize(State{pole_stretch, pole_stretch, curvature * pole_stretch * start, 0, 0, 0}, start, start);
  const auto system = [&](const State& state, State& slope, double R) { slope = meridian(material, state, R); };
  std::pair<double, double> last_step;
  constexpr int most_steps = 100'000;
  for (int k = 0; stepper.current_state()[1] > 1; ++k) {
    if (k == most_steps)
      throw InputError(fmt::format("{}: no inflated circle of pole stretch {}", material.model(), pole_stretch));
    last_step = stepper.do_step(system);
  }

  State rim;
  const auto hoop_strain = [&](double R) {
    stepper.calc_state(R, rim);
    return rim[1] - 1;
  };
  boost::uintmax_t iterations = 100;
  const auto bracket = boost::math::tools::toms748_solve(hoop_strain, last_step.first, last_step.second,
                                                         boost::math::tools::eps_tolerance<double>(45), iterations);
  const double R = bracket.first, unit = radius / R;
  stepper.calc_state(R, rim);
  return {R * material.shear_modulus() * thickness / radius, rim[3] * unit, rim[4] * unit * unit * unit,
          rim[5] * unit * unit};
}

}  // namespace softform
