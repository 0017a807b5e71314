#include "softform/materials/wrinkle_smoothing.hpp"

#include <cmath>

namespace softform {
namespace {

// The branches of (6.6), differentiated; taut minus wrinkled is what the second stretch adds.
double wrinkled_by_1(double kappa, double l_1) { return kappa * (1 - std::pow(l_1, -1.5)); }
double wrinkled_by_11(double kappa, double l_1) { return 1.5 * kappa * std::pow(l_1, -2.5); }
double added_by_1(double kappa, double l_1, double l_2)
{
  return kappa * (std::pow(l_1, -1.5) - 1 / (l_1 * l_1 * l_2));
}
double added_by_11(double kappa, double l_1, double l_2)
{
  return kappa * (2 / (l_1 * l_1 * l_1 * l_2) - 1.5 * std::pow(l_1, -2.5));
}
double taut_by_2(double kappa, double l_1, double l_2) { return kappa * (1 - 1 / (l_1 * l_2 * l_2)); }
double taut_by_22(double kappa, double l_1, double l_2) { return 2 * kappa / (l_1 * l_2 * l_2 * l_2); }

// The function above the interval, zero below it, the transition on it.
template <class Function>
double smoothed(double x, const TransitionInterval& interval, const Function& function)
{
  if (x >= interval.u) return function(x);
  if (x <= interval.start()) return 0;
  return transition(x - interval.intersection(), interval.c, interval.eps);
}

}  // namespace

StretchDerivatives relaxed_derivatives(double kappa, double lambda_1, double lambda_2)
{
  if (lambda_1 < 1) return {};
  StretchDerivatives psi{wrinkled_by_1(kappa, lambda_1), 0};
  if (lambda_2 * std::sqrt(lambda_1) < 1) return psi;
  psi.by_1 += added_by_1(kappa, lambda_1, lambda_2);
  psi.by_2 = taut_by_2(kappa, lambda_1, lambda_2);
  return psi;
}

double transition(double t, double c, double eps) { return c / (4 * eps) * t * t + c / 2 * t + c * eps / 4; }

TransitionInterval slack_to_wrinkled(double kappa, double delta, double lambda_2)
{
  const double u = 1 + delta * (1 - lambda_2), c = wrinkled_by_11(kappa, u);
  return {u, c, wrinkled_by_1(kappa, u) / c};
}

TransitionInterval wrinkled_to_taut_by_1(double kappa, double delta, double lambda_2)
{
  const double line = 1 / (lambda_2 * lambda_2), u = line + delta * (line - lambda_2);
  const double c = added_by_11(kappa, u, lambda_2);
  return {u, c, added_by_1(kappa, u, lambda_2) / c};
}

TransitionInterval wrinkled_to_taut_by_2(double kappa, double delta, double lambda_1)
{
  const double line = 1 / std::sqrt(lambda_1), u = line + delta * (lambda_1 - line);
  const double c = taut_by_22(kappa, lambda_1, u);
  return {u, c, taut_by_2(kappa, lambda_1, u) / c};
}

StretchDerivatives thesis_smoothed_derivatives(double kappa, double delta, double lambda_1, double lambda_2)
{
  // Beyond the rest state there is no line to smooth: along lambda_1 for lambda_2 >= 1, along lambda_2 for lambda_1
  // <= 1.
  StretchDerivatives psi = relaxed_derivatives(kappa, lambda_1, lambda_2);
  if (lambda_2 < 1) {
    psi.by_1 = smoothed(lambda_1, slack_to_wrinkled(kappa, delta, lambda_2),
                        [&](double l_1) { return wrinkled_by_1(kappa, l_1); });
    psi.by_1 += smoothed(lambda_1, wrinkled_to_taut_by_1(kappa, delta, lambda_2),
                         [&](double l_1) { return added_by_1(kappa, l_1, lambda_2); });
  }
  if (lambda_1 > 1)
    psi.by_2 = smoothed(lambda_2, wrinkled_to_taut_by_2(kappa, delta, lambda_1),
                        [&](double l_2) { return taut_by_2(kappa, lambda_1, l_2); });
  return psi;
}

}  // namespace softform
