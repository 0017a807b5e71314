// The relaxed energy with a barrier: derivatives everywhere, the minimum that defines it, its limit (6.6).
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "softform/materials/barrier_tension_field.hpp"
#include "softform/materials/tension_field.hpp"
#include "support/expect_input_error.hpp"
#include "support/material_slopes.hpp"

namespace softform::testing {
namespace {

using softform::test::expect_input_error;

constexpr double kappa = 2e5, barrier = 1e-2, residual = 1e-3;

struct Deformation {
  std::string name;
  double lambda_1, lambda_2;

  double trace() const { return lambda_1 + lambda_2; }
  double determinant() const { return lambda_1 * lambda_2; }
};
const std::vector<Deformation> deformations{
    {"Slack", 0.8, 0.5},       {"SlackFlat", 0.6, 1e-3}, {"Wrinkled", 1.5, 0.4}, {"AboutToWrinkle", 1.5, 0.85},
    {"AboutToSlack", 1.03, 1}, {"Taut", 1.5, 1.1},       {"Stretched", 9, 5}};

class BarrierTensionFields : public ::testing::TestWithParam<Deformation> {};

TEST_P(BarrierTensionFields, DensityHasTheRightSlopes)
{
  const Deformation& C = GetParam();
  const BarrierTensionField material(kappa, barrier, residual);
  expect_density_slopes(material, C.trace(), C.determinant());
  expect_same_density_of_strain(material, C.trace(), C.determinant());
}

TEST_P(BarrierTensionFields, ParametersHaveTheRightSlopes)
{
  const Deformation& C = GetParam();
  const auto material = [](const Vec& v) { return BarrierTensionField(v[0], v[1], v[2]); };
  expect_parameter_slopes(material, Vec3(kappa, barrier, residual), C.trace(), C.determinant());
}

TEST_P(BarrierTensionFields, PanelsHaveTheRightSlopes)
{
  const Deformation& C = GetParam();
  expect_panel_slopes(std::make_shared<BarrierTensionField>(kappa, barrier, residual), C.lambda_1, C.lambda_2);
}

// By search over what wrinkles take up, without the equations of the minimum.
TEST_P(BarrierTensionFields, EnergyIsTheLeastOverWhatWrinklesTakeUp)
{
  const Deformation& C = GetParam();
  const auto energy = [&](const Eigen::Vector2d& logarithms) {
    const Eigen::Vector2d w = logarithms.array().exp(), mu = Eigen::Vector2d(C.lambda_1, C.lambda_2) + w;
    return mu.sum() + 1 / mu.prod() - 3 - barrier * logarithms.sum();
  };
  Eigen::Vector2d at(std::log(0.1), std::log(0.1));
  double least = energy(at);
  for (double step = 1; step > 1e-9;) {
    const double before = least;
    for (const Eigen::Vector2d& way : {Eigen::Vector2d(1, 0), Eigen::Vector2d(0, 1)})
      for (const double sign : {1.0, -1.0})
        while (energy(at + sign * step * way) < least) least = energy(at += sign * step * way);
    if (least == before) step /= 2;
  }
  const BarrierTensionField material(kappa, barrier);
  EXPECT_NEAR(material.density(C.trace(), C.determinant(), Order::Value).psi / kappa, least, 1e-12 * (1 + least));
}

INSTANTIATE_TEST_SUITE_P(Deformations, BarrierTensionFields, ::testing::ValuesIn(deformations),
                         [](const auto& deformation) { return deformation.param.name; });

// Where the stretches are equal (t, d) end, and (6.6) with its smoothing has a singularity at the rest state.
TEST(BarrierTensionField, PassesThroughEqualStretchesAndTheRestState)
{
  const auto material = std::make_shared<BarrierTensionField>(kappa, barrier, residual);
  for (const double lambda : {0.7, 1.0, 1.4}) expect_panel_slopes(material, lambda, lambda, 1e-4, 0);
}

TEST(BarrierTensionField, TendsToTheRelaxedEnergy)
{
  const TensionField relaxed(kappa);
  for (const Deformation& C : deformations) {
    const double exact = relaxed.density(C.trace(), C.determinant(), Order::Value).psi;
    double last = HUGE_VAL;
    for (const double nu : {1e-4, 1e-6, 1e-8, 1e-10}) {
      const BarrierTensionField material(kappa, nu);
      const double error = std::abs(material.density(C.trace(), C.determinant(), Order::Value).psi - exact);
      EXPECT_LT(error, 0.05 * last) << C.name << " " << nu;
      last = error;
    }
    EXPECT_LT(last, 1e-8 * kappa) << C.name;
  }
}

// In a wrinkle that takes up w the stress is nu / w: psi_lambda_2 = psi_t + lambda_1 psi_d.
TEST(BarrierTensionField, PullsOnWrinklesByTheBarrierOverTheirWidth)
{
  constexpr double nu = 1e-8, lambda_1 = 1.21, lambda_2 = 0.5;
  const BarrierTensionField material(kappa, nu);
  const MembraneDensity f = material.density(lambda_1 + lambda_2, lambda_1 * lambda_2, Order::Gradient);
  const double width = 1 / std::sqrt(lambda_1) - lambda_2;
  EXPECT_NEAR((f.psi_t + lambda_1 * f.psi_d) / kappa, nu / width, 1e-6 * nu);
}

TEST(BarrierTensionField, IsFiniteForEveryDeformation)
{
  for (const double nu : {1e-10, 1e-6, 1e-2, 1.0})
    for (const double lambda_1 : {1e-9, 1e-3, 0.9, 1.0, 1 + 1e-9, 1.01, 3.0, 1e4})
      for (const double ratio : {0.0, 1e-9, 0.5, 1 - 1e-9, 1.0}) {
        const double lambda_2 = ratio * lambda_1;
        const MembraneDensity f =
            BarrierTensionField(1, nu).density(lambda_1 + lambda_2, lambda_1 * lambda_2, Order::Third);
        EXPECT_TRUE(std::isfinite(f.psi) && gradient_of(f).allFinite() && hessian_of(f).allFinite() &&
                    third_of(f).allFinite())
            << nu << " " << lambda_1 << " " << lambda_2;
        // The stress is positive in both directions.
        EXPECT_GT(f.psi_t + lambda_2 * f.psi_d, 0) << nu << " " << lambda_1 << " " << lambda_2;
      }
}

TEST(BarrierTensionField, NotANumberStaysNotANumber)
{
  EXPECT_TRUE(std::isnan(BarrierTensionField(kappa, barrier).density(NAN, 1, Order::Value).psi));
  EXPECT_TRUE(std::isnan(BarrierTensionField(kappa, barrier).density(2, NAN, Order::Value).psi));
}

TEST(BarrierTensionField, RefusesBadParameters)
{
  expect_input_error([] { BarrierTensionField(-1, 1); }, {"kappa"});
  expect_input_error([] { BarrierTensionField(1, 0); }, {"barrier"});
  expect_input_error([] { BarrierTensionField(1, 1, NAN); }, {"residual"});
}

}  // namespace
}  // namespace softform::testing
