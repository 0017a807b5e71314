#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <ostream>
#include <vector>

#include "softform/core/types.hpp"

/// Finite differences that judge a derivative by its order of convergence: a wrong derivative has order zero.
namespace softform::testing {

using VectorFunction = std::function<Vec(const Vec&)>;

/// Where the function may be evaluated around the point: on both sides, or only along +direction.
enum class Side { Both, Forward };

/// What shrinking steps showed. Errors are relative to the larger of the derivative and `scale`.
struct SlopeCheck {
  double smallest_error = 0;
  double order = 0;  ///< of the error in the step, while above round-off; 2 for
                     /// < a right derivative

  /// Right when the error falls with second order, or was at round-off from the start (polynomials).
  bool passes() const { return smallest_error < 1e-6 && (order > 1.7 || largest_error < 1e-8); }

  double largest_error = 0;
};

inline std::ostream& operator<<(std::ostream& stream, const SlopeCheck& check)
{
  return stream << "finite differences: errors " << check.largest_error << " -> " << check.smallest_error << ", order "
                << check.order;
}

/// Second-order difference quotient of f at x along `direction`.
inline Vec difference_quotient(const VectorFunction& f, const Vec& x, const Vec& direction, double h, Side side)
{
  if (side == Side::Both) return (f(x + h * direction) - f(x - h * direction)) / (2 * h);
  return (-3 * f(x) + 4 * f(x + h * direction) - f(x + 2 * h * direction)) / (2 * h);
}

/// Compares `exact`, the derivative of f at x along `direction`, with difference quotients of steps h, h/2, h/4, ...
/// `scale` is a size below which the derivative counts as zero. NaN anywhere fails.
inline SlopeCheck check_slope(const VectorFunction& f, const Vec& x, const Vec& direction, const Vec& exact,
                              double first_step = 1e-2, double scale = 1e-12, Side side = Side::Both)
{
  std::vector<double> errors;
  double h = first_step;
  for (int k = 0; k < 12; ++k, h /= 2) {
    const double error = (difference_quotient(f, x, direction, h, side) - exact).norm();
    errors.push_back(error / std::max(exact.norm(), scale));
  }
  SlopeCheck check;
  check.largest_error = errors.front();
  check.smallest_error = *std::min_element(errors.begin(), errors.end());
  check.order = std::log2(errors[0] / errors[2]) / 2;
  for (const double error : errors)
    if (!std::isfinite(error)) check.smallest_error = error;
  return check;
}

}  // namespace softform::testing
