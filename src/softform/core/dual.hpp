#pragma once

#include <array>
#include <cmath>

#include <Eigen/Core>

namespace softform {

/// A number with its first derivatives by up to `n` independent variables (forward differentiation).
template <int n>
class DualNumber {
  using Dual = DualNumber;

 public:
  static constexpr int variables = n;

  DualNumber(double number = 0)
      : value_(number) {}  // NOLINT(google-explicit-constructor): constants mix with variables

  /// The independent variable number i. Precondition: 0 <= i < variables.
  static Dual variable(double number, int i) { return with_derivative(number, i, 1); }
  static Dual with_derivative(double number, int i, double derivative)
  {
    Dual x(number);
    x.derivatives_[std::size_t(i)] = derivative;
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

template <int n>
DualNumber<n> exp(const DualNumber<n>& x)
{
  return chain(x, std::exp(x.value()), std::exp(x.value()));
}
template <int n>
DualNumber<n> log(const DualNumber<n>& x)
{
  return chain(x, std::log(x.value()), 1 / x.value());
}
template <int n>
DualNumber<n> sinh(const DualNumber<n>& x)
{
  return chain(x, std::sinh(x.value()), std::cosh(x.value()));
}
template <int n>
DualNumber<n> cosh(const DualNumber<n>& x)
{
  return chain(x, std::cosh(x.value()), std::sinh(x.value()));
}
template <int n>
DualNumber<n> sqrt(const DualNumber<n>& x)
{
  return chain(x, std::sqrt(x.value()), 0.5 / std::sqrt(x.value()));
}

/// Densities take it as their parameters' scalar, so that a fit has exact derivatives of every model. As many variables
/// as the most parameters that a model may have: four terms of Ogden's sum.
using Dual = DualNumber<8>;

}  // namespace softform

template <int n>
struct Eigen::NumTraits<softform::DualNumber<n>> : Eigen::GenericNumTraits<softform::DualNumber<n>> {
  enum { RequireInitialization = 1, ReadCost = 1 + n, AddCost = 1 + n, MulCost = 2 + 3 * n };
};
