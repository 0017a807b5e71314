// Purpose: the thesis' smoothing at work (6.12)-(6.13), figure 6.9: the derivative of the relaxed energy in lambda_1 at
// a fixed lambda_2, from slack to wrinkled, and the quadratic in between. Corrected: c is the wrinkled branch's second
// derivative, not the slack one's, which is zero. Claim: the transition joins both branches with their slopes, and its
// interval shrinks to nothing towards the rest state.

#include <cmath>

#include "softform/experiment/experiment.hpp"
#include "softform/experiment/run.hpp"
#include "softform/materials/wrinkle_smoothing.hpp"

namespace {

using namespace softform;

constexpr double kappa = 1, delta = 0.3, lambda_2 = 0.4;

void smooth_one_derivative(Run& run)
{
  // 1. The interval [u - 2 eps, u] of (6.12), (6.13).
  const TransitionInterval interval = slack_to_wrinkled(kappa, delta, lambda_2);
  run.metric("u", interval.u, "1");
  run.metric("eps", interval.eps, "1");
  run.metric("intersection", interval.intersection(), "1");

  // 2. Values and slopes at its ends.
  const auto h = [&](double l_1) { return transition(l_1 - interval.intersection(), interval.c, interval.eps); };
  const auto relaxed = [](double l_1) { return relaxed_derivatives(kappa, l_1, lambda_2).by_1; };
  constexpr double step = 1e-5;
  const auto slope = [&](const auto& f, double x) { return (f(x + step) - f(x - step)) / (2 * step); };
  run.metric("value_error_left", std::abs(h(interval.start())), "1");
  run.metric("value_error_right", std::abs(h(interval.u) - relaxed(interval.u)), "1");
  run.metric("slope_error_left", std::abs(slope(h, interval.start())), "1");
  run.metric("slope_error_right", std::abs(slope(h, interval.u) - slope(relaxed, interval.u)), "1");
  run.metric("eps_near_rest", slack_to_wrinkled(kappa, delta, 1 - 1e-6).eps, "1");

  // 3. The curves.
  auto& curves = run.series("curves", {{"lambda_1", "1"}, {"relaxed", "1"}, {"smoothed", "1"}});
  const int samples = run.by_size(200, 1000);
  for (int k = 0; k <= samples; ++k) {
    const double l_1 = 0.7 + 0.8 * k / samples;
    curves.add_row({l_1, relaxed(l_1), thesis_smoothed_derivatives(kappa, delta, l_1, lambda_2).by_1});
  }
}

}  // namespace

int main(int argc, char** argv)
{
  return softform::run_experiment(argc, argv,
                                  {"fig_6_9",
                                   "6.5.2",
                                   "The thesis' transition joins slack and wrinkled derivatives with their slopes.",
                                   {0.01, 0.01}},
                                  smooth_one_derivative);
}
