// Pattern optimisation (6.16) on a small sphere of three lunes.

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "softform/inflatables/pattern_optimization.hpp"
#include "softform/inflatables/sheet_material.hpp"
#include "softform/materials/registry.hpp"
#include "softform/mesh/shapes.hpp"
#include "support/expect_input_error.hpp"

namespace softform::testing {
namespace {

class LuneSphere : public ::testing::Test {
 protected:
  LuneSphere()
  {
    inflation = design_inflation(*film, 1e-3, 1, 2);
    options.stop.max_iterations = 12;
    start = inflated_panels(three_lune_sphere(1, 5), inflation);
  }

  double mean_distance(const InflatedPanels& panels) const
  {
    return sampled_distance(skin_mesh(panels.layout, panels.x), target.distance(), 5000).mean / target.size();
  }

  // kappa h = 40 p x size, as of polyester film of 25 um at 1 kPa on 40 cm.
  std::unique_ptr<Material> film = make_material("neo_hookean", {{"mu", 1.6e5}});
  PatternTarget target{irregular_sphere(1, 1000)};
  InflationSettings inflation;
  PatternOptions options;
  InflatedPanels start;
};

TEST_F(LuneSphere, ComesCloserWithSeamsThatFit)
{
  const PatternOptimum optimum = optimize_pattern(start, target, inflation, options);
  EXPECT_LT(mean_distance(optimum.panels), 0.75 * mean_distance(start));
  EXPECT_LT(seam_mismatch(optimum.panels.layout).max, 0.02);
  EXPECT_LT(optimum.residual, 1e-5);
  EXPECT_GT(flat_quality(optimum.panels.layout).minCoeff(), 0);
}

// Every iterate is the inflated shape of its panels, and on one mesh the objective only falls.
TEST_F(LuneSphere, EveryIterateIsADesign)
{
  inflation.first_material = nullptr;
  double last = HUGE_VAL;
  int remeshings = 0, seen = 0;
  optimize_pattern(start, target, inflation, options, [&](const PatternProgress& now) {
    if (now.remeshings != remeshings) last = HUGE_VAL;
    remeshings = now.remeshings;
    EXPECT_LT(now.iterate.objective, last);
    last = now.iterate.objective;
    const Inflatable inflatable(now.panels.layout, inflation.material, inflation.thickness, inflation.pressure);
    Vec forces;
    inflatable.gradient(now.panels.x, flat_vector(now.panels.layout), forces);
    EXPECT_LT(largest_nodal_norm(forces) / inflatable.force_scale(), 1e-5);
    ++seen;
    return true;
  });
  EXPECT_GE(seen, 12);
}

TEST_F(LuneSphere, StopsWhenAskedAndGoesOnFromThere)
{
  const auto stop_after = [](int count) {
    return [count](const PatternProgress& now) { return now.iterate.k < count; };
  };
  const PatternOptimum first = optimize_pattern(start, target, inflation, options, stop_after(2));
  EXPECT_EQ(first.report.termination, Termination::Interrupted);
  const PatternOptimum second = optimize_pattern(first.panels, target, inflation, options, stop_after(3));
  EXPECT_LT(mean_distance(second.panels), mean_distance(start));
  // A panel made larger, as after a seam was edited: the same call takes it from there.
  InflatedPanels edited = second.panels;
  edited.layout.flat.topRows(edited.layout.panels[0].vertex_count) *= 1.05;
  const PatternOptimum third = optimize_pattern(edited, target, inflation, options, stop_after(3));
  EXPECT_LT(seam_mismatch(third.panels.layout).max, 0.02);
}

TEST_F(LuneSphere, BadTrianglesAreMeshedAnew)
{
  // A thin triangle in the middle of a panel.
  InflatedPanels bad = start;
  const Panel& panel = bad.layout.panels[0];
  int inner = -1;
  std::vector<int> neighbours;
  const auto loops = boundary_loops(bad.layout, 0);
  for (int v = panel.first_vertex; v < panel.first_vertex + panel.vertex_count; ++v)
    if (std::find(loops[0].begin(), loops[0].end(), v) == loops[0].end()) inner = v;
  ASSERT_GE(inner, 0);
  for (int t = 0; t < panel.triangle_count; ++t)
    for (int k = 0; k < 3; ++k)
      if (bad.layout.triangles(t, k) == inner) neighbours.push_back(bad.layout.triangles(t, (k + 1) % 3));
  bad.layout.flat.row(inner) += 0.8 * (bad.layout.flat.row(neighbours[0]) - bad.layout.flat.row(inner));
  options.remeshing.quality_threshold = 0.9;
  options.weights.interior = 0;
  const PatternOptimum optimum = optimize_pattern(bad, target, inflation, options);
  EXPECT_GT(optimum.remeshings, 0);
  EXPECT_EQ(optimum.panels.layout.panels.size(), 3U);
}

// The last iterate may be followed by a remeshing whose panels find no equilibrium in the iterations that are left:
// what is returned is the iterate, not the panels just meshed.
TEST_F(LuneSphere, WhatIsReturnedIsInEquilibriumWhereverItStops)
{
  options.remeshing.quality_threshold = 0.9;
  for (const int iterations : {1, 2, 3}) {
    options.stop.max_iterations = iterations;
    const PatternOptimum optimum = optimize_pattern(start, target, inflation, options);
    const Inflatable inflatable(optimum.panels.layout, inflation.material, inflation.thickness, inflation.pressure);
    Vec forces;
    inflatable.gradient(optimum.panels.x, flat_vector(optimum.panels.layout), forces);
    EXPECT_LT(largest_nodal_norm(forces) / inflatable.force_scale(), 1e-5) << iterations;
  }
}

// The relaxed energy's kinks left the gradient at a hundredth, whatever the steps.
TEST_F(LuneSphere, ReachesTheThesisGradient)
{
  options.stop.max_iterations = 200;
  start = inflated_panels(three_lune_sphere(1, 7), inflation);
  const PatternOptimum optimum = optimize_pattern(start, target, inflation, options);
  EXPECT_TRUE(optimum.report.converged()) << optimum.report.message;
  EXPECT_LT(optimum.report.trace.back().stationarity, 1e-3);
  // Sheets that wrinkle at once take nearly the same shape.
  const Equilibrium sheets = inflate_again(optimum.panels, sheet_inflation(*film, 1e-3, 1, 2));
  EXPECT_TRUE(sheets.report.converged());
  EXPECT_LT((sheets.x - optimum.panels.x).lpNorm<Eigen::Infinity>(), 0.01 * target.size());
}

class RefusedDesign : public LuneSphere {
 protected:
  static PatternObjectiveSettings at_least(double quality)
  {
    PatternObjectiveSettings objectives;
    objectives.least_quality = quality;
    return objectives;
  }
  std::optional<Vec> restored(const Vec& flat, const PatternObjectiveSettings& objectives) const
  {
    const auto program = pattern_program(start.layout, start.x, inflation, target.field(), objectives);
    Vec z(start.x.size() + flat.size());
    z << start.x, flat;
    return program->restore(z);
  }
};

// One step had folded a panel's tip into a sliver that no new triangles mend.
TEST_F(RefusedDesign, WithATriangleWorseThanItMayBe)
{
  const Vec flat = flat_vector(start.layout);
  const double quality = flat_quality(start.layout).minCoeff();
  EXPECT_TRUE(restored(flat, at_least(0.9 * quality)));
  EXPECT_FALSE(restored(flat, at_least(1.1 * quality)));
  Vec turned = flat;
  for (Eigen::Index v = 0; v < turned.size() / 2; ++v) turned[2 * v] *= -1;
  EXPECT_FALSE(restored(turned, at_least(0)));
}

// The thesis' own method, through the same interface.
TEST_F(LuneSphere, SequentialQuadraticProgrammingTakesTheProgramme)
{
  options.optimizer = "sqp";
  const PatternOptimum optimum = optimize_pattern(start, target, inflation, options);
  ASSERT_FALSE(optimum.report.trace.empty());
  EXPECT_TRUE(optimum.panels.x.allFinite());
  EXPECT_LT(optimum.report.trace.back().objective, optimum.report.trace.front().objective);
}

TEST_F(LuneSphere, UnknownOptimizerIsNamed)
{
  options.optimizer = "simplex";
  test::expect_input_error([&] { optimize_pattern(start, target, inflation, options); }, {"simplex"});
}

}  // namespace
}  // namespace softform::testing
