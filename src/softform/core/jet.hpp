#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace softform {

/// The Taylor polynomial of a function of two variables, truncated at total degree `order`: a number that carries all
/// partial derivatives up to that order through a formula. Jet<0> is a plain number.
template <int order>
class Jet {
 public:
  Jet(double number = 0) { coefficients_[0] = number; }  // NOLINT(google-explicit-constructor): constants mix with jets

  /// The independent variables themselves.
  static Jet first(double number) { return variable(number, 1); }
  static Jet second(double number) { return variable(number, 2); }

  double value() const { return coefficients_[0]; }
  /// The derivative, i times by the first and j times by the second variable; 0 beyond the order.
  double derivative(int i, int j) const
  {
    constexpr std::array<double, 4> factorial{1, 1, 2, 6};
    static_assert(order < static_cast<int>(factorial.size()));
    return i + j > order ? 0 : factorial[std::size_t(i)] * factorial[std::size_t(j)] * coefficients_[place(i, j)];
  }

  friend Jet operator+(const Jet& a, const Jet& b) { return combine(a, b, 1); }
  friend Jet operator-(const Jet& a, const Jet& b) { return combine(a, b, -1); }
  friend Jet operator*(const Jet& a, const Jet& b)
  {
    Jet product;
    for (int n = 0; n <= order; ++n)
      for (int j = 0; j <= n; ++j) add_products(a, b, n - j, j, product.coefficients_[place(n - j, j)]);
    return product;
  }
  friend Jet operator/(const Jet& a, const Jet& b)
  {
    const double u = 1 / b.value();
    return a * chain(b, {u, -u * u, u * u * u, -u * u * u * u});
  }
  friend Jet sqrt(const Jet& x)
  {
    const double root = std::sqrt(x.value()), u = 1 / x.value();
    return chain(x, {root, root * u / 2, -root * u * u / 8, root * u * u * u / 16});
  }
  friend Jet log(const Jet& x)
  {
    const double u = 1 / x.value();
    return chain(x, {std::log(x.value()), u, -u * u / 2, u * u * u / 3});
  }

 private:
  static constexpr std::size_t size = std::size_t(order + 1) * (order + 2) / 2;
  static constexpr std::size_t place(int i, int j) { return std::size_t((i + j) * (i + j + 1) / 2 + j); }

  static Jet variable(double number, std::size_t which)
  {
    Jet x(number);
    if (order > 0) x.coefficients_[which % size] = 1;
    return x;
  }
  static Jet combine(const Jet& a, const Jet& b, double sign)
  {
    Jet sum;
    for (std::size_t k = 0; k < size; ++k) sum.coefficients_[k] = a.coefficients_[k] + sign * b.coefficients_[k];
    return sum;
  }
  // The coefficient (i, j) of the product.
  static void add_products(const Jet& a, const Jet& b, int i, int j, double& sum)
  {
    for (int k = 0; k <= i; ++k)
      for (int l = 0; l <= j; ++l) sum += a.coefficients_[place(k, l)] * b.coefficients_[place(i - k, j - l)];
  }
  // A function of x from its Taylor coefficients at x.value(), by Horner's rule.
  static Jet chain(const Jet& x, const std::array<double, 4>& taylor)
  {
    const Jet change = x - x.value();
    Jet result = taylor[std::size_t(order)];
    for (int k = order - 1; k >= 0; --k) result = taylor[std::size_t(k)] + change * result;
    return result;
  }

  std::array<double, size> coefficients_{};
};

}  // namespace softform
