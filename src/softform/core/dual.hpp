#pragma once

#include <cmath>

namespace softform {

/// A number and its derivative in one variable: first-order forward differentiation of templated formulas.
struct Dual {
  double value = 0;
  double slope = 0;

  Dual() = default;
  Dual(double number) : value(number) {}  // NOLINT: constants mix with duals as numbers do
  Dual(double number, double derivative) : value(number), slope(derivative) {}

  Dual& operator+=(const Dual& b) { return *this = *this + b; }
  Dual& operator*=(const Dual& b) { return *this = *this * b; }

  friend Dual operator-(const Dual& a) { return {-a.value, -a.slope}; }
  friend Dual operator+(const Dual& a, const Dual& b) { return {a.value + b.value, a.slope + b.slope}; }
  friend Dual operator-(const Dual& a, const Dual& b) { return {a.value - b.value, a.slope - b.slope}; }
  friend Dual operator*(const Dual& a, const Dual& b)
  {
    return {a.value * b.value, a.slope * b.value + a.value * b.slope};
  }
  friend Dual operator/(const Dual& a, const Dual& b)
  {
    const double quotient = a.value / b.value;
    return {quotient, (a.slope - quotient * b.slope) / b.value};
  }
  friend bool operator<(const Dual& a, const Dual& b) { return a.value < b.value; }
  friend bool operator>(const Dual& a, const Dual& b) { return a.value > b.value; }

  friend Dual exp(const Dual& a) { return {std::exp(a.value), std::exp(a.value) * a.slope}; }
  friend Dual cosh(const Dual& a) { return {std::cosh(a.value), std::sinh(a.value) * a.slope}; }
  friend Dual sinh(const Dual& a) { return {std::sinh(a.value), std::cosh(a.value) * a.slope}; }
};

}  // namespace softform
