// Balloon design from target to rest shape (thesis chapter 4).

#include <cmath>

#include <gtest/gtest.h>

#include "softform/balloons/balloon_design.hpp"
#include "softform/mesh/self_intersections.hpp"
#include "softform/mesh/shapes.hpp"
#include "support/expect_input_error.hpp"
#include "support/test_balloon.hpp"

namespace softform::testing {
namespace {

void expect_sound(const BalloonDesign& design)
{
  EXPECT_EQ(design.negative_eigenvalues, 0);
  EXPECT_LT(design.residual, 1e-6);
  EXPECT_EQ(count_self_intersections(design.rest), 0);
  EXPECT_GT(design.pressure, 0);
  EXPECT_GT(design.mean_stretch, 1);
}

// The inflated shape that is returned is the equilibrium of the rest shape that is returned.
void expect_equilibrium(const BalloonDesign& design, const std::shared_ptr<const Material>& material)
{
  TestBalloon balloon(design.rest, material);
  const Equilibrium found =
      solve_at_pressure(balloon.balloon, design.pressure, flatten(design.inflated.vertices), balloon.factorization);
  ASSERT_TRUE(found.report.converged()) << found.report.message;
  const double moved = (found.x - flatten(design.inflated.vertices)).cwiseAbs().maxCoeff();
  EXPECT_LT(moved, 1e-4 * diameter(design.inflated.vertices));
}

TEST(BalloonDesign, BumpsphereComesCloserThanTheDownscaledTarget)
{
  const TriangleMesh target = scale_to_diameter(bumpsphere(1, 1000), 0.146);
  const BalloonDesign design = design_balloon(target, silicone());
  EXPECT_NE(design.report.termination, Termination::Infeasible) << design.report.message;
  expect_sound(design);
  expect_equilibrium(design, silicone());
  const double before = shape_distance(design.downscaled, target).mean;
  const double after = shape_distance(design.inflated, target).mean;
  EXPECT_LT(5 * after, before);
  EXPECT_NEAR(enclosed_volume(design.inflated), enclosed_volume(target), 1e-9 * enclosed_volume(target));
  EXPECT_EQ(design.rest.triangles, target.triangles);
}

TEST(BalloonDesign, PhasesAndCountsAreParts)
{
  const BalloonDesign design = design_balloon(irregular_sphere(0.05, 250), silicone());
  const BalloonTimes& times = design.times;
  for (const double phase : {times.inflation, times.assembly, times.factorization, times.solve, times.equilibrium,
                             times.collision, times.rest()}) {
    EXPECT_GT(phase, 0);
    EXPECT_LT(phase, times.total);
  }
  const BalloonCounts& counts = design.counts;
  EXPECT_LT(counts.shape_steps, design.report.evaluations.linear_solve);  // which has those of equilibria as well
  EXPECT_GE(counts.shape_steps, design.report.trace.back().k);
  EXPECT_GT(counts.equilibria, design.report.trace.back().k);
  EXPECT_GE(counts.equilibrium_steps, counts.equilibria - 1);
  EXPECT_GT(counts.inflation_steps, 0);
}

// A sphere's rest shape is a sphere, though its triangulation has no symmetry.
TEST(BalloonDesign, SymmetricTargetStaysSymmetric)
{
  const TriangleMesh target = irregular_sphere(0.05, 400);
  const BalloonDesign design = design_balloon(target, silicone());
  expect_sound(design);
  const Eigen::RowVector3d centre = design.rest.vertices.colwise().mean();
  const Vec radii = (design.rest.vertices.rowwise() - centre).rowwise().norm();
  const double size = diameter(design.rest.vertices);
  EXPECT_LT(radii.maxCoeff() - radii.mean(), 0.01 * size);
  EXPECT_LT(radii.mean() - radii.minCoeff(), 0.01 * size);
}

TEST(BalloonDesign, InterruptedOptimisationLeavesTheBestRestShape)
{
  const TriangleMesh target = scale_to_diameter(bumpsphere(1, 1000), 0.146);
  const BalloonDesign design = design_balloon(target, silicone(), {}, [](const BalloonProgress& progress) {
    return progress.iterate == nullptr || progress.iterate->k < 2;
  });
  EXPECT_EQ(design.report.termination, Termination::Interrupted);
  expect_sound(design);
  expect_equilibrium(design, silicone());
  EXPECT_LT(design.report.trace.back().objective, design.report.trace.front().objective);
  // It is no longer the downscaled target.
  const Positions change = design.rest.vertices - BalloonOptions{}.rest_scale * target.vertices;
  EXPECT_GT((change.rowwise() - change.colwise().mean()).cwiseAbs().maxCoeff(), 1e-3 * diameter(design.rest.vertices));
}

TEST(BalloonDesign, InterruptedInflationLeavesTheDownscaledTarget)
{
  const TriangleMesh target = irregular_sphere(0.05, 250);
  const BalloonDesign design = design_balloon(target, silicone(), {}, [](const BalloonProgress&) { return false; });
  EXPECT_EQ(design.report.termination, Termination::Interrupted);
  EXPECT_EQ(design.rest.vertex_count(), target.vertex_count());
  EXPECT_TRUE(design.rest.vertices.allFinite() && design.inflated.vertices.allFinite());
}

// Started where the last one ended, a design is that one again.
TEST(BalloonDesign, StartsFromAnEarlierOptimum)
{
  const TriangleMesh target = irregular_sphere(0.05, 250);
  const BalloonDesign first = design_balloon(target, silicone());
  BalloonOptions options;
  options.start = BalloonStart{first.rest.vertices / first.size_factor, first.inflated.vertices / first.size_factor};
  options.stop.max_iterations = 0;
  const BalloonDesign second = design_balloon(target, silicone(), options);
  expect_sound(second);
  const double size = diameter(first.rest.vertices);
  EXPECT_LT((second.rest.vertices - first.rest.vertices).cwiseAbs().maxCoeff(), 1e-6 * size);
  EXPECT_NEAR(second.pressure, first.pressure, 1e-6 * first.pressure);
}

TEST(BalloonDesign, InvalidOptionsAreRefused)
{
  const TriangleMesh target = irregular_sphere(0.05, 250);
  const auto expect_refused = [&](const BalloonOptions& options, const std::string& text) {
    test::expect_input_error([&] { design_balloon(target, silicone(), options); }, {text});
  };
  const double nan = std::nan("");
  for (const double bad : {0.0, -3e-4, nan, HUGE_VAL}) {
    BalloonOptions options;
    options.thickness = bad;
    expect_refused(options, "thickness");
  }
  for (const double bad : {0.0, -0.5, 1.0, 2.0, nan}) {
    BalloonOptions options;
    options.rest_scale = bad;
    expect_refused(options, "rest scale");
  }
  BalloonOptions options;
  options.start = BalloonStart{target.vertices, Positions::Zero(3, 3)};
  expect_refused(options, "the start has 250 vertices at rest and 3 inflated");
}

}  // namespace
}  // namespace softform::testing
