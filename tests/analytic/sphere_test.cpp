// The balloon whose answer is known: a sphere under inner pressure (thesis 4.3.1).

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "softform/balloons/spherical_balloon.hpp"
#include "softform/mesh/shapes.hpp"
#include "support/materials.hpp"
#include "support/test_balloon.hpp"

namespace softform::testing {
namespace {

constexpr double radius = 0.03;     // [m]
constexpr double thickness = 3e-4;  // [m]

TEST(SphericalBalloon, PressureOfNeoHookeanAndMooneyRivlin)
{
  const auto neo_hookean = make_material("neo_hookean", {{"mu", 0.3e6}});
  const auto mooney_rivlin = make_material("mooney_rivlin", {{"mu_1", 0.3e6}, {"mu_2", 0.02e6}});
  for (const double L : {1.0, 1.05, 1.5, 4.0}) {
    const double shape = 2 * thickness / radius * (1 / L - std::pow(L, -7));
    EXPECT_NEAR(spherical_balloon_pressure(*neo_hookean, thickness, radius, L), 0.3e6 * shape, 1e-8);
    EXPECT_NEAR(spherical_balloon_pressure(*mooney_rivlin, thickness, radius, L), (0.3e6 + 0.02e6 * L * L) * shape,
                1e-8);
  }
}

// The pressure is dE/dV of the balloon's energy, for every material.
TEST(SphericalBalloon, PressureIsTheSlopeOfTheEnergy)
{
  for (const std::string& name : model_names()) {
    const auto material = example_of(name);
    const double L = 1.7, h = 1e-4;
    const auto total_energy = [&](double l) { return 3 * thickness / radius * energy(*material, l, l); };
    const double slope = (total_energy(L + h) - total_energy(L - h)) / (std::pow(L + h, 3) - std::pow(L - h, 3));
    EXPECT_NEAR(spherical_balloon_pressure(*material, thickness, radius, L) / slope, 1, 1e-6) << name;
  }
}

// Largest relative error of the pressure over stretches on both sides of the limit points.
double largest_error(const std::string& model, int vertex_count)
{
  const std::shared_ptr<const Material> material = example_of(model);
  TestBalloon sphere(irregular_sphere(radius, vertex_count), material, thickness);
  Equilibrium state;
  state.x = sphere.balloon.rest_positions();
  double last = 1, error = 0;
  for (const double stretch : {1.15, 1.3, 1.5, 1.75, 2.0, 2.5}) {
    state = sphere.at_stretch(stretch, state, last);
    EXPECT_TRUE(state.report.converged()) << state.report.message << " at stretch " << stretch;
    last = stretch;
    const double exact = spherical_balloon_pressure(*material, thickness, radius, stretch);
    error = std::max(error, std::abs(state.pressure / exact - 1));
  }
  return error;
}

class SphereConvergence : public ::testing::TestWithParam<std::string> {};

TEST_P(SphereConvergence, IsOfSecondOrderThroughTheLimitPoint)
{
  const double coarse = largest_error(GetParam(), 250), fine = largest_error(GetParam(), 1000);
  EXPECT_LT(fine, 0.02);
  // Four times the vertices halve the mesh size.
  EXPECT_GT(std::log2(coarse / fine), 1.8) << "errors " << coarse << " -> " << fine;
}

INSTANTIATE_TEST_SUITE_P(Materials, SphereConvergence, ::testing::ValuesIn(model_names()),
                         [](const auto& model) { return model.param; });

// A neo-Hookean balloon bears its greatest pressure at the stretch 7^(1/6), where d/dL (1/L - 1/L^7) = 0.
TEST(SphericalBalloon, NeoHookeanPressurePeaksAtTheLimitPoint)
{
  TestBalloon sphere(irregular_sphere(radius, 400), neo_hookean(), thickness);
  const double step = 0.02;
  Equilibrium state = sphere.at_stretch(1.2);
  double greatest = 0, at_stretch = 0;
  for (double stretch = 1.2; stretch < 1.61; stretch += step) {
    state = sphere.at_stretch(stretch, state, stretch == 1.2 ? stretch : stretch - step);
    ASSERT_TRUE(state.report.converged()) << state.report.message;
    if (state.pressure > greatest) {
      greatest = state.pressure;
      at_stretch = stretch;
    }
  }
  EXPECT_NEAR(at_stretch, std::pow(7, 1 / 6.0), step);
}

}  // namespace
}  // namespace softform::testing
