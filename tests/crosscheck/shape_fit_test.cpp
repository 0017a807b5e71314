// The fit by shape: derivatives, the two formulations against each other, and what it recovers.

#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "softform/fitting/membrane_test_curve.hpp"
#include "softform/fitting/shape_fit.hpp"
#include "softform/materials/registry.hpp"
#include "softform/optimizers/augmented_lagrangian.hpp"
#include "softform/optimizers/reduced_gauss_newton.hpp"
#include "support/deformations.hpp"
#include "support/expect_input_error.hpp"
#include "support/finite_differences.hpp"

namespace softform::testing {
namespace {

constexpr double radius = 0.03;                              // [m]
const std::vector<double> truth{0.16163e6, 0.0219, 0.2453};  // G [Pa], k1, k2

std::shared_ptr<const Material> silicone()
{
  return make_material("hart_smith", {{"G", truth[0]}, {"k1", truth[1]}, {"k2", truth[2]}});
}

// One sample of 0.5 mm, its scans noisy and incomplete; the other instruments are exact.
CampaignOptions scan_errors_only(int steps)
{
  CampaignOptions options;
  options.thicknesses = {0.5e-3};
  options.samples = 1;
  options.volumes = equal_volume_steps(6 * std::pow(radius, 3), steps);
  options.thickness_error = options.volume_error = options.pressure_error = 0;
  options.rings = 24;
  return options;
}

ShapeFit fit_of(const CampaignOptions& options, const std::vector<double>& start)
{
  ShapeFit fit;
  fit.model = "hart_smith";
  fit.start = start;
  fit.steps = shape_steps(simulate_campaign(silicone(), options), radius, {.centres = 300});
  return fit;
}

ShapeFit far_fit(int steps) { return fit_of(scan_errors_only(steps), {3 * truth[0], truth[1] / 3, 3 * truth[2]}); }

Vec gradient(const NonlinearProgram& program, const Vec& z)
{
  Vec g;
  program.objective_gradient(z, g);
  return g;
}

TEST(ShapeFitDerivatives, ReducedGradient)
{
  for (const Control control : {Control::Volume, Control::Pressure}) {
    ShapeFit fit = fit_of(scan_errors_only(3), {1.3 * truth[0], truth[1], 0.8 * truth[2]});
    fit.control = control;
    const auto program = reduced_program(fit);
    const Vec z = program->initial_point(), direction = wiggle(3, 2);
    const auto objective = [&](const Vec& y) { return Vec::Constant(1, program->objective(y)); };
    EXPECT_SLOPE(check_slope(objective, z, direction, Vec::Constant(1, gradient(*program, z).dot(direction)), 1e-2));
  }
}

TEST(ShapeFitDerivatives, FullSpaceGradientAndJacobian)
{
  const auto program = full_space_program(far_fit(2));
  const Vec z = program->initial_point(), direction = wiggle(program->variable_count(), 3);
  const auto objective = [&](const Vec& y) { return Vec::Constant(1, program->objective(y)); };
  EXPECT_SLOPE(check_slope(objective, z, direction, Vec::Constant(1, gradient(*program, z).dot(direction)), 1e-3));
  SparseMatrix J;
  program->constraint_jacobian(z, J);
  const auto constraints = [&](const Vec& y) {
    Vec c;
    program->constraints(y, c);
    return c;
  };
  EXPECT_SLOPE(check_slope(constraints, z, direction, J * direction, 1e-3));
}

// A trial step may leave the model's range: that is a point without values, not an error.
TEST(ShapeFit, FullSpaceOutOfTheModelsRangeIsNotFinite)
{
  const auto program = full_space_program(far_fit(2));
  const Vec inside = program->initial_point();
  Vec outside = inside, c;
  outside[inside.size() - 3] = 1e4;  // exp overflows
  SparseMatrix J, J_inside;
  program->constraints(outside, c);
  program->constraint_jacobian(outside, J);
  program->constraint_jacobian(inside, J_inside);
  EXPECT_EQ(c.size(), program->constraint_count());
  EXPECT_TRUE(c.array().isNaN().all());
  EXPECT_TRUE(J.coeffs().isNaN().all());
  EXPECT_EQ(J.nonZeros(), J_inside.nonZeros());
  EXPECT_FALSE(program->restore(outside).has_value());
  EXPECT_TRUE(J_inside.coeffs().isFinite().all());
}

TEST(ShapeFit, BothFormulationsFindTheSameParameters)
{
  const ShapeFit fit = far_fit(4);
  const Solution reduced =
      ReducedGaussNewton().minimize(*reduced_program(fit), {.relative_decrease = 1e-8, .patience = 2});
  const Solution full =
      AugmentedLagrangian().minimize(*full_space_program(fit), {.max_iterations = 300, .relative_decrease = 0});
  // Asked for more than round-off allows, it may say that it stalled: what counts is where.
  EXPECT_LT(full.report.trace.back().infeasibility, 1e-8);
  EXPECT_LT((reduced.z - full.z.tail(3)).cwiseAbs().maxCoeff(), 1e-5);
  EXPECT_NEAR(full.objective / reduced.objective, 1, 1e-6);
}

TEST(ShapeFit, RecoversTheKnownMaterialFromFarAway)
{
  const ShapeFitResult result = fit_shape(far_fit(10));
  ASSERT_TRUE(result.report.converged()) << result.report.message;
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(result.parameters[k] / truth[k], 1, 0.01);
    // The two meshes alone are farther off: what the extrapolation is for.
    EXPECT_GT(std::abs(result.fine[k] / truth[k] - 1), std::abs(result.parameters[k] / truth[k] - 1));
  }
}

// No step decreases the objective of the coarse mesh then: that is an optimum, not a failure.
TEST(ShapeFit, StartedAtTheOptimumStaysThere)
{
  ShapeFit fit = far_fit(4);
  const ShapeFitResult first = fit_shape(fit);
  ASSERT_TRUE(first.report.converged()) << first.report.message;
  fit.start = first.coarse;
  const ShapeFitResult second = fit_shape(fit);
  ASSERT_TRUE(second.report.converged()) << second.report.message;
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(second.parameters[k] / first.parameters[k], 1, 1e-5);
}

TEST(ShapeFit, TakesTheBestOfSeveralStarts)
{
  ShapeFit fit = far_fit(4);
  const ShapeFitResult good = fit_shape(fit);
  const std::vector<double> far = std::exchange(fit.start, {truth[0], 30, truth[2]});  // exp(k1 (I1 - 3)^2) overflows
  const ShapeFitResult bad = fit_shape(fit);
  EXPECT_FALSE(bad.report.converged());
  EXPECT_TRUE(std::isnan(bad.objective) && std::isnan(bad.parameters[0]) && std::isnan(bad.fine[0]));
  const ShapeFitResult best = fit_shape(fit, {far});
  ASSERT_TRUE(best.report.converged()) << best.report.message;
  EXPECT_EQ(best.parameters, good.parameters);
}

// Latex has a limit point of the pressure among these steps: no branch of given pressures goes through it.
TEST(ShapeFit, PrescribedPressureFailsBehindALimitPoint)
{
  const std::vector<double> latex{0.2734e6, 3.443e-4, 0.7445};
  CampaignOptions options = scan_errors_only(10);
  options.volumes = equal_volume_steps(20 * std::pow(radius, 3), 10);
  ShapeFit fit = fit_of(options, {2 * latex[0], latex[1] / 3, latex[2]});
  fit.steps = shape_steps(
      simulate_campaign(make_material("hart_smith", {{"G", latex[0]}, {"k1", latex[1]}, {"k2", latex[2]}}), options),
      radius, {.centres = 300});
  // On a coarse mesh alone: its G is 8 % too small.
  const auto modulus_error = [&](Control control) {
    fit.control = control;
    const Solution solution = ReducedGaussNewton().minimize(*reduced_program(fit), {.max_iterations = 12});
    return std::abs(fitted_material(fit, solution.z)->parameters()[0].value / latex[0] - 1);
  };
  EXPECT_LT(modulus_error(Control::Volume), 0.1);
  EXPECT_GT(modulus_error(Control::Pressure), 0.5);
  EXPECT_FALSE(fit_shape(fit).report.converged());
}

TEST(ShapeFit, RefusesWhatMakesNoSense)
{
  ShapeFit fit = far_fit(2);
  fit.start[1] = 0;
  test::expect_input_error([&] { reduced_program(fit); }, {"k1", "other than 0"});
  fit.start.pop_back();
  test::expect_input_error([&] { reduced_program(fit); }, {"hart_smith has 3 parameters", "2"});
  fit = far_fit(2);
  std::swap(fit.steps[0], fit.steps[1]);
  test::expect_input_error([&] { full_space_program(fit); }, {"step 1", "volumes must rise"});
  CampaignOptions options = scan_errors_only(2);
  options.volumes = {2e-5, 1e-5};
  test::expect_input_error([&] { simulate_campaign(silicone(), options); }, {"must rise"});
}

// The scan of a campaign tells the extension and the volume of the sheet.
TEST(Campaign, ScansTellExtensionAndVolume)
{
  const CampaignOptions options = scan_errors_only(4);
  const InflationCurve exact = inflation_curve(*silicone(), 0.5e-3, radius, options.volumes.back());
  const auto samples = simulate_campaign(silicone(), options);
  for (const LoadingStep& step : samples.front().steps) {
    EXPECT_LT(step.scan.rows(), 0.95 * options.scan_points);  // holes, and the edge that the clamp hides
    EXPECT_GT(step.scan.rows(), 0.5 * options.scan_points);
    const ScannedSheet sheet = measure_scan(RbfImplicit(step.scan, Vec3::Zero(), {}, rim(radius)), radius, step.volume);
    EXPECT_NEAR(sheet.extension / exact.extension_at_volume(step.volume), 1, 3e-3);
    EXPECT_NEAR(sheet.volume / step.volume, 1, 3e-3);
    const double pressure = exact.pressure_at_volume(step.volume) * samples.front().thickness / 0.5e-3;
    EXPECT_NEAR(step.pressure / pressure, 1, 5e-3);
  }
}

InflationCurve curve_of_stiffness(const std::vector<double>& stiffness)
{
  const auto n = static_cast<Eigen::Index>(stiffness.size());
  InflationCurve curve{Vec::LinSpaced(n + 1, 0, double(n)), Vec::LinSpaced(n + 1, 1, double(n + 1)), Vec::Zero(n + 1)};
  for (Eigen::Index k = 0; k < n; ++k)
    curve.pressure[k + 1] = curve.pressure[k] + stiffness[static_cast<std::size_t>(k)];
  return curve;
}

TEST(Regimes, AreBoundedHalfWayDownAndUp)
{
  const InflationCurve curve = curve_of_stiffness({10, 9, 3, 2, 2, 6, 20, 22});
  const auto bounds = three_regimes(curve);
  EXPECT_EQ(bounds, (std::array<double, 4>{1, 3, 7, 9}));
  const auto stiffness = regime_stiffness(curve, bounds);
  EXPECT_NEAR(stiffness[0], 9.5, 1e-12);
  EXPECT_NEAR(stiffness[1], 13.0 / 4, 1e-12);
  EXPECT_NEAR(stiffness[2], 21, 1e-12);
  test::expect_input_error([] { three_regimes(curve_of_stiffness({10, 9, 3, 2, 2, 1})); }, {"no three regimes"});
  test::expect_input_error([] { three_regimes(curve_of_stiffness({1, 2, 3})); }, {"too few"});
}

}  // namespace
}  // namespace softform::testing
