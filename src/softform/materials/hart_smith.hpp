#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "softform/materials/invariant_density.hpp"
#include "softform/materials/material_model.hpp"

namespace softform {

/// Integral of exp(k s^2) over s = 0 ... x for k >= 0: sqrt(pi/k)/2 erfi(sqrt(k) x) without its 0/0 at k = 0. Accurate
/// to round-off; infinite only where exp(k x^2) itself overflows.
template <class Scalar>
Scalar exponential_integral_of_square(const Scalar& k, double x);

/// Hart-Smith (4.10, A.7): dPsi/dI1 = G exp(k1 (I1 - 3)^2), dPsi/dI2 = G k2/I2. G is in Pa. Its energy, which the
/// thesis leaves out, is G * (integral above)(k1, I1 - 3) + G k2 ln(I2/3).
template <class Scalar>
struct HartSmith {
  Scalar G, k1, k2;

  static HartSmith from(const std::vector<Scalar>& parameters) { return {parameters[0], parameters[1], parameters[2]}; }

  Scalar shear_modulus() const { return 2.0 * G * (1.0 + k2 / 3.0); }

  BasicMembraneDensity<Scalar> density(double t, double d, Order order) const
  {
    using std::exp;
    const double I2 = second_invariant(t, d), x = first_invariant(t, d) - 3;
    const Scalar f_1 = G * exp(k1 * (x * x));
    const InvariantTerm<Scalar> f{G * exponential_integral_of_square(k1, x), f_1, f_1 * k1 * (2 * x),
                                  f_1 * k1 * (2.0 + k1 * (4 * x * x))};
    const Scalar Gk2 = G * k2;
    const InvariantTerm<Scalar> g{Gk2 * std::log(I2 / 3), Gk2 / I2, -Gk2 / (I2 * I2), Gk2 * (2 / (I2 * I2 * I2))};
    return invariant_density(f, g, t, d, order);
  }
};

/// 1 / n and 1 / (2n + 1) for n = 0 ... 199: the series below would spend its time on divisions.
struct ReciprocalTable {
  std::array<double, 200> of_n{}, of_odd{};
  constexpr ReciprocalTable()
  {
    for (std::size_t n = 1; n < of_n.size(); ++n) {
      of_n[n] = 1 / static_cast<double>(n);
      of_odd[n] = 1 / static_cast<double>(2 * n + 1);
    }
  }
};
inline constexpr ReciprocalTable reciprocal;

template <class Scalar>
Scalar exponential_integral_of_square(const Scalar& k, double x)
{
  using std::exp;
  constexpr double epsilon = 1e-17;
  const Scalar z = k * (x * x);
  if (z < 40.0) {
    // x * sum z^n / (n! (2n + 1)): every term is positive, so nothing cancels.
    Scalar power{1}, sum{1};
    std::size_t n = 1;
    do {
      power *= z * reciprocal.of_n[n];
      sum += power * reciprocal.of_odd[n];
    } while (power > epsilon * sum && ++n < 200);
    return x * sum;
  }
  // x exp(z)/(2z) * (1 + 1/(2z) + 1*3/(2z)^2 + ...): the asymptotic series, below round-off before it diverges.
  const Scalar w = 1.0 / (2.0 * z);
  Scalar term{1}, sum{1};
  for (double n = 1; n < 2 * 40 && term > epsilon; n += 2) {
    term *= n * w;
    sum += term;
  }
  return x * exp(z) * w * sum;
}

/// Throws InputError unless G > 0, k1 >= 0 and k2 >= 0.
void check_parameters(const HartSmith<double>& model);

MaterialModel hart_smith_model();

}  // namespace softform
