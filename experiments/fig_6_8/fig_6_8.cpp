// Purpose: the quadratic that joins two lines with both their first derivatives (thesis (6.7)-(6.11), figure 6.8).
// Claim: it meets values and slopes at both ends.

#include <algorithm>
#include <cmath>

#include "softform/experiment/experiment.hpp"
#include "softform/experiment/run.hpp"
#include "softform/materials/wrinkle_smoothing.hpp"

namespace {

using namespace softform;

void join_two_lines(Run& run)
{
  // 1. g_1 = 0 and g_2 = c x, as in (6.7).
  constexpr double c = 1.3, eps = 0.4;
  const auto h = [&](double x) { return transition(x, c, eps); };

  // 2. (6.8): values, and slopes by central differences, exact for a quadratic up to round-off.
  constexpr double step = 1e-3;
  const auto slope = [&](double x) { return (h(x + step) - h(x - step)) / (2 * step); };
  run.metric("value_error_left", std::abs(h(-eps)), "1");
  run.metric("value_error_right", std::abs(h(eps) - c * eps), "1");
  run.metric("slope_error_left", std::abs(slope(-eps)), "1");
  run.metric("slope_error_right", std::abs(slope(eps) - c), "1");

  // 3. The curves.
  auto& curves = run.series("curves", {{"x", "1"}, {"lines", "1"}, {"transition", "1"}});
  const int samples = run.by_size(100, 400);
  for (int k = 0; k <= samples; ++k) {
    const double x = -1 + 2.0 * k / samples;
    curves.add_row({x, std::max(0.0, c * x), std::abs(x) <= eps ? h(x) : std::max(0.0, c * x)});
  }
  run.metric("eps", eps, "1");
}

}  // namespace

int main(int argc, char** argv)
{
  return softform::run_experiment(
      argc, argv, {"fig_6_8", "6.5.2", "A quadratic joins two lines with values and slopes.", {0.01, 0.01}},
      join_two_lines);
}
