#pragma once

#include <array>
#include <cmath>

namespace softform {

/// A number with its first derivatives by up to `Dual::variables` independent variables (forward differentiation).
/// Densities take it as their parameters' scalar, so that a fit has exact derivatives of every model.
class Dual {
 public:
  static constexpr int variables = 8;  ///< the most parameters that a model may have: four terms of Ogden's sum

  Dual(double number = 0) : value_(number) {}  // NOLINT(google-explicit-constructor): constants mix with variables

  /// The independent variable number i. Precondition: 0 <= i < variables.
  static Dual variable(double number, int i)
  {
    Dual x(number);
    x.derivatives_[std::size_t(i)] = 1;
    return x;
  }

  double value() const { return value_; }
  double derivative(int i) const { return derivatives_[std::size_t(i)]; }

  /// f(x) with f(x.value()) and f'(x.value()) given.
  friend Dual chain(const Dual& x, double f, double f_1)
  {
    Dual y(f);
    for (std::size_t i = 0; i < variables; ++i) y.derivatives_[i] = f_1 * x.derivatives_[i];
    return y;
  }

  Dual& operator+=(const Dual& b) { return *this = combine(*this, b, value_ + b.value_, 1, 1); }
  Dual& operator*=(const Dual& b) { return *this = *this * b; }
  friend Dual operator-(const Dual& a) { return chain(a, -a.value_, -1); }
  friend Dual operator+(const Dual& a, const Dual& b) { return combine(a, b, a.value_ + b.value_, 1, 1); }
  friend Dual operator-(const Dual& a, const Dual& b) { return combine(a, b, a.value_ - b.value_, 1, -1); }
  friend Dual operator*(const Dual& a, const Dual& b) { return combine(a, b, a.value_ * b.value_, b.value_, a.value_); }
  friend Dual operator/(const Dual& a, const Dual& b)
  {
    const double quotient = a.value_ / b.value_;
    return combine(a, b, quotient, 1 / b.value_, -quotient / b.value_);
  }
  friend bool operator<(const Dual& a, const Dual& b) { return a.value_ < b.value_; }
  friend bool operator>(const Dual& a, const Dual& b) { return a.value_ > b.value_; }

 private:
  static Dual combine(const Dual& a, const Dual& b, double f, double f_a, double f_b)
  {
    Dual y(f);
    for (std::size_t i = 0; i < variables; ++i) y.derivatives_[i] = f_a * a.derivatives_[i] + f_b * b.derivatives_[i];
    return y;
  }

  double value_;
  std::array<double, variables> derivatives_{};
};

inline Dual exp(const Dual& x) { return chain(x, std::exp(x.value()), std::exp(x.value())); }
inline Dual log(const Dual& x) { return chain(x, std::log(x.value()), 1 / x.value()); }
inline Dual sinh(const Dual& x) { return chain(x, std::sinh(x.value()), std::cosh(x.value())); }
inline Dual cosh(const Dual& x) { return chain(x, std::cosh(x.value()), std::sinh(x.value())); }

}  // namespace softform
