// Purpose: the landscape of the relaxed energy's first derivatives over the squared stretches (thesis 6.5.2, figure
// 6.7): as they are, with the thesis' smoothing (6.12)-(6.13), and with ours, which smooths the energy itself.
// Claim: both smoothings replace the kinks at the two lines between slack, wrinkled and taut by transitions that are
// continuously differentiable. Only ours belongs to an energy.

#include <algorithm>
#include <cmath>
#include <functional>

#include <fmt/format.h>

#include "softform/experiment/experiment.hpp"
#include "softform/experiment/run.hpp"
#include "softform/materials/tension_field.hpp"
#include "softform/materials/wrinkle_smoothing.hpp"

namespace {

using namespace softform;

constexpr double kappa = 1, delta = 0.1, energy_delta = 0.1;

using Derivatives = std::function<StretchDerivatives(double lambda_1, double lambda_2)>;

// d/d lambda_1 = d/dt + lambda_2 d/dd, and the same for lambda_2.
StretchDerivatives energy_derivatives(const TensionField& material, double lambda_1, double lambda_2)
{
  const MembraneDensity f = material.density(lambda_1 + lambda_2, lambda_1 * lambda_2, Order::Gradient);
  return {f.psi_t + lambda_2 * f.psi_d, f.psi_t + lambda_1 * f.psi_d};
}

// The largest change of a function's slope over three samples: that of a kink between them, or next to nothing.
double largest_kink(const std::function<double(double)>& f, double from, double to)
{
  constexpr int samples = 200'000;
  const double h = (to - from) / samples;
  const auto slope = [&](int k) { return (f(from + (k + 1) * h) - f(from + k * h)) / h; };
  double largest = 0;
  for (int k = 2; k < samples; ++k) largest = std::max(largest, std::abs(slope(k) - slope(k - 2)));
  return largest;
}

// d(psi_1)/d lambda_2 - d(psi_2)/d lambda_1, zero where an energy exists; the largest on a grid, off the kinks.
double largest_curl(const Derivatives& psi)
{
  constexpr double h = 1e-6;
  double largest = 0;
  for (double l_1 = 0.8; l_1 < 2; l_1 += 0.01) {
    for (double l_2 = 0.3; l_2 < std::min(l_1 - 0.02, 1.4); l_2 += 0.01) {
      if (std::min(std::abs(l_1 - 1), std::abs(l_2 - 1 / std::sqrt(l_1))) < 10 * h) continue;
      const double by_2 = psi(l_1, l_2 + h).by_1 - psi(l_1, l_2 - h).by_1;
      const double by_1 = psi(l_1 + h, l_2).by_2 - psi(l_1 - h, l_2).by_2;
      largest = std::max(largest, std::abs(by_2 - by_1) / (2 * h));
    }
  }
  return largest;
}

void draw_landscapes(Run& run)
{
  const TensionField smoothed(kappa, energy_delta);
  const std::vector<std::pair<const char*, Derivatives>> kinds{
      {"relaxed", [](double l_1, double l_2) { return relaxed_derivatives(kappa, l_1, l_2); }},
      {"thesis", [](double l_1, double l_2) { return thesis_smoothed_derivatives(kappa, delta, l_1, l_2); }},
      {"energy", [&](double l_1, double l_2) { return energy_derivatives(smoothed, l_1, l_2); }}};
  constexpr double fixed_2 = 0.7, fixed_1 = 1.6;
  const int grid = run.by_size(60, 80);
  for (const auto& [name, psi] : kinds) {
    run.step(name);
    // 1. Kinks along lambda_1, across both lines, and along lambda_2.
    const Derivatives& f = psi;
    const auto along_1 = [&](double l_1) { return f(l_1, fixed_2).by_1; };
    run.metric(fmt::format("kink_slack_wrinkled_{}", name), largest_kink(along_1, 0.72, 1.5), "1");
    run.metric(fmt::format("kink_wrinkled_taut_by_1_{}", name), largest_kink(along_1, 1.5, 3), "1");
    const auto along_2 = [&](double l_2) { return f(fixed_1, l_2).by_2; };
    run.metric(fmt::format("kink_wrinkled_taut_by_2_{}", name), largest_kink(along_2, 0.4, 1.5), "1");
    run.metric(fmt::format("curl_{}", name), largest_curl(psi), "1");

    // 2. The landscape over kappa.
    auto& table = run.series(fmt::format("landscape_{}", name),
                             {{"lambda_1", "1"}, {"lambda_2", "1"}, {"psi_1", "1"}, {"psi_2", "1"}});
    for (int i = 0; i <= grid; ++i) {
      for (int j = 0; j <= grid; ++j) {
        const double l_1 = 0.5 + 2 * double(i) / grid, l_2 = 0.2 + 1.6 * double(j) / grid;
        const StretchDerivatives at = psi(std::max(l_1, l_2), std::min(l_1, l_2));
        table.add_row({l_1, l_2, l_1 >= l_2 ? at.by_1 : at.by_2, l_1 >= l_2 ? at.by_2 : at.by_1});
      }
    }
  }
}

}  // namespace

int main(int argc, char** argv)
{
  return softform::run_experiment(
      argc, argv,
      {"fig_6_7",
       "6.5.2",
       "Smoothing replaces the kinks of the relaxed energy's derivatives by continuously differentiable transitions.",
       {0.01, 0.05}},
      draw_landscapes);
}
