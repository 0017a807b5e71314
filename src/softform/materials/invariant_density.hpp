#pragma once

#include "softform/materials/material.hpp"

namespace softform {

/// A function of one invariant and its first three derivatives.
template <class Scalar>
struct InvariantTerm {
  Scalar value{0}, first{0}, second{0}, third{0};
};

/// The invariants of C at lambda_3^2 = 1/d (thesis A.1 with I3 = 1).
inline double first_invariant(double t, double d) { return t + 1 / d; }
inline double second_invariant(double t, double d) { return d + t / d; }

/// Psi(t, d) = f(I1) + g(I2) and its derivatives by the chain rule. The invariants are linear in t, hence I1_d =
/// -1/d^2, I2_t = 1/d, I2_d = 1 - t/d^2 and so on; I1_td = I1_tt = I2_tt = 0.
template <class Scalar>
BasicMembraneDensity<Scalar> invariant_density(const InvariantTerm<Scalar>& f, const InvariantTerm<Scalar>& g, double t,
                                               double d, Order order)
{
  const double u = 1 / d, u2 = u * u, u3 = u2 * u, u4 = u2 * u2;
  const double I1_d = -u2, I1_dd = 2 * u3, I1_ddd = -6 * u4;
  const double I2_t = u, I2_td = -u2, I2_tdd = 2 * u3;
  const double I2_d = 1 - t * u2, I2_dd = 2 * t * u3, I2_ddd = -6 * t * u4;

  BasicMembraneDensity<Scalar> density;
  density.psi = f.value + g.value;
  if (order == Order::Value) return density;

  density.psi_t = f.first + g.first * I2_t;
  density.psi_d = f.first * I1_d + g.first * I2_d;
  if (order == Order::Gradient) return density;

  density.psi_tt = f.second + g.second * (I2_t * I2_t);
  density.psi_td = f.second * I1_d + g.second * (I2_t * I2_d) + g.first * I2_td;
  density.psi_dd = f.second * (I1_d * I1_d) + f.first * I1_dd + g.second * (I2_d * I2_d) + g.first * I2_dd;
  if (order == Order::Hessian) return density;

  density.psi_ttt = f.third + g.third * (I2_t * I2_t * I2_t);
  density.psi_ttd = f.third * I1_d + g.third * (I2_t * I2_t * I2_d) + g.second * (2 * I2_t * I2_td);
  density.psi_tdd = f.third * (I1_d * I1_d) + f.second * I1_dd + g.third * (I2_t * I2_d * I2_d) +
                    g.second * (2 * I2_d * I2_td + I2_t * I2_dd) + g.first * I2_tdd;
  density.psi_ddd = f.third * (I1_d * I1_d * I1_d) + f.second * (3 * I1_d * I1_dd) + f.first * I1_ddd +
                    g.third * (I2_d * I2_d * I2_d) + g.second * (3 * I2_d * I2_dd) + g.first * I2_ddd;
  return density;
}

}  // namespace softform
