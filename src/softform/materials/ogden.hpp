#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "softform/materials/material_model.hpp"

namespace softform {

/// The Chebyshev function of real order, T_p(c) = cosh(p arcosh c), and its derivatives in c, for c >= 1.
template <class Scalar>
struct ChebyshevFunction {
  Scalar T, T_1, T_2, T_3;
};

template <class Scalar>
ChebyshevFunction<Scalar> chebyshev_function(const Scalar& p, double c);

/// Ogden (A.6), incompressible, in the principal stretches:
///     Psi = sum_j 2 mu_j/alpha_j^2 (lambda_1^alpha_j + lambda_2^alpha_j + lambda_3^alpha_j - 3),   mu_j in Pa.
///
/// In t and d: lambda_1^2 and lambda_2^2 are sqrt(d) e^(+-w) with cosh w = c = t/(2 sqrt d), so with p = alpha/2
///     lambda_1^alpha + lambda_2^alpha = 2 d^(p/2) T_p(c)   and lambda_3^alpha = d^-p,
/// which is smooth where the two stretches are equal (c = 1): no eigenvalues, no division by their difference.
template <class Scalar>
struct Ogden {
  std::vector<Scalar> mu, alpha;

  /// parameters: mu_1, alpha_1, mu_2, alpha_2, ...
  static Ogden from(const std::vector<Scalar>& parameters)
  {
    Ogden model;
    for (std::size_t j = 0; j + 1 < parameters.size(); j += 2) {
      model.mu.push_back(parameters[j]);
      model.alpha.push_back(parameters[j + 1]);
    }
    return model;
  }

  Scalar shear_modulus() const
  {
    Scalar sum{0};
    for (const Scalar& modulus : mu) sum += modulus;
    return sum;
  }

  BasicMembraneDensity<Scalar> density(double t, double d, Order order) const
  {
    BasicMembraneDensity<Scalar> total;
    for (std::size_t j = 0; j < mu.size(); ++j) add_term(mu[j], alpha[j], t, d, order, total);
    return total;
  }

 private:
  static void add_term(const Scalar& mu, const Scalar& alpha, double t, double d, Order order,
                       BasicMembraneDensity<Scalar>& total);
};

/// One term. Derivatives follow from d/dd [d^m F(c)] = d^(m-1) (m F - c F'/2) and d/dt [d^m F(c)] = d^(m-1/2) F'/2.
template <class Scalar>
void Ogden<Scalar>::add_term(const Scalar& mu, const Scalar& alpha, double t, double d, Order order,
                             BasicMembraneDensity<Scalar>& total)
{
  using std::exp;
  const double root = std::sqrt(d), c = t / (2 * root);
  const Scalar p = alpha / 2.0, q = p / 2.0, k = 2.0 * mu / (alpha * alpha);
  const auto [T, T_1, T_2, T_3] = chebyshev_function(p, c);
  const Scalar in_plane = k * exp(q * std::log(d));  // k d^q
  const Scalar across = k * exp(-p * std::log(d));   // k lambda_3^alpha

  total.psi += 2.0 * in_plane * T + across - 3.0 * k;
  if (order == Order::Value) return;

  const Scalar A = 2.0 * q * T - c * T_1;  // d/dd of the first term is k d^(q-1) A
  total.psi_t += in_plane / root * T_1;
  total.psi_d += (in_plane * A - p * across) / d;
  if (order == Order::Gradient) return;

  const Scalar A_1 = (2.0 * q - 1.0) * T_1 - c * T_2;
  const Scalar B = (q - 1.0) * A - 0.5 * c * A_1;  // the second derivative is k d^(q-2) B
  total.psi_tt += in_plane / (2 * d) * T_2;
  total.psi_td += in_plane / (2 * d * root) * A_1;
  total.psi_dd += (in_plane * B + p * (p + 1.0) * across) / (d * d);
  if (order == Order::Hessian) return;

  const Scalar A_2 = (2.0 * q - 2.0) * T_2 - c * T_3;
  const Scalar B_1 = (q - 1.5) * A_1 - 0.5 * c * A_2;
  total.psi_ttt += in_plane / (4 * d * root) * T_3;
  total.psi_ttd += in_plane / (4 * d * d) * A_2;
  total.psi_tdd += in_plane / (2 * d * d * root) * B_1;
  total.psi_ddd += (in_plane * ((q - 2.0) * B - 0.5 * c * B_1) - p * (p + 1.0) * (p + 2.0) * across) / (d * d * d);
}

template <class Scalar>
ChebyshevFunction<Scalar> chebyshev_function(const Scalar& p, double c)
{
  using std::cosh, std::sinh;
  const double y = c - 1;
  const Scalar pp = p * p;
  if (y * (1.0 + pp) < 0.05) {
    // T_p(1 + y) = sum a_n y^n with a_(n+1)/a_n = (p^2 - n^2)/((2n + 1)(n + 1)); Horner for all four at once.
    constexpr int last = 14;
    std::array<Scalar, last + 1> a;
    a[0] = Scalar(1);
    for (int n = 0; n < last; ++n) a[n + 1] = a[n] * (pp - double(n * n)) / double((2 * n + 1) * (n + 1));
    ChebyshevFunction<Scalar> sum{a[last], Scalar(0), Scalar(0), Scalar(0)};
    for (int n = last - 1; n >= 0; --n) {
      sum.T_3 = sum.T_3 * y + 3.0 * sum.T_2;
      sum.T_2 = sum.T_2 * y + 2.0 * sum.T_1;
      sum.T_1 = sum.T_1 * y + sum.T;
      sum.T = sum.T * y + a[n];
    }
    return sum;
  }
  // Apart: T' from its closed form, T'' and T''' from Chebyshev's equation (1 - c^2) T'' - c T' + p^2 T = 0.
  const double w = std::acosh(c), s2 = y * (c + 1);
  ChebyshevFunction<Scalar> value;
  value.T = cosh(p * w);
  value.T_1 = p * sinh(p * w) / std::sqrt(s2);
  value.T_2 = (pp * value.T - c * value.T_1) / s2;
  value.T_3 = ((pp - 1.0) * value.T_1 - 3.0 * c * value.T_2) / s2;
  return value;
}

/// Throws InputError unless every alpha_j is non-zero and the shear modulus, the sum of the mu_j, is positive.
void check_parameters(const Ogden<double>& model);

MaterialModel ogden_model();

}  // namespace softform
