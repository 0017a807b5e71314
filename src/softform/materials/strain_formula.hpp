#pragma once

// Energy densities written as one formula in trace and determinant of the strain C~ - 1, differentiated by jets.

#include "softform/core/jet.hpp"
#include "softform/materials/material.hpp"

namespace softform {

/// Trace and determinant of C~ - 1.
template <class Number>
struct Strain {
  Number trace, determinant;
};

/// These as the variables to differentiate by.
template <class Number>
Strain<Number> strain_itself(const CauchyGreenInvariants& C)
{
  return {Number::first(C.strain_trace), Number::second(C.strain_determinant)};
}

/// These as functions of the variables t and d.
template <class Number>
Strain<Number> strain_of(double t, double d)
{
  return {Number::first(t - 2), Number::second(d - 1) - Number::first(t - 2)};
}

/// The neo-Hookean energy (6.3) over kappa, t + 1/d - 3 (B.20): without a difference of large numbers.
template <class Number>
Number neo_hookean_energy(const Strain<Number>& strain)
{
  const Number a = strain.trace, b = strain.determinant;
  return (a * a + a * b - b) / (1 + a + b);
}

template <class Number>
MembraneDensity density_of(const Number& psi)
{
  return {psi.derivative(0, 0), psi.derivative(1, 0), psi.derivative(0, 1), psi.derivative(2, 0), psi.derivative(1, 1),
          psi.derivative(0, 2), psi.derivative(3, 0), psi.derivative(2, 1), psi.derivative(1, 2), psi.derivative(0, 3)};
}

/// energy: a function of (Jet's tag) that returns the energy [Pa] with derivatives up to the order.
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

}  // namespace softform
