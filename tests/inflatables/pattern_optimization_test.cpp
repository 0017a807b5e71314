// Pattern optimisation (6.16) on a small sphere of three lunes.

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "softform/inflatables/pattern_optimization.hpp"
#include "softform/materials/tension_field.hpp"
#include "softform/mesh/shapes.hpp"
#include "support/expect_input_error.hpp"

namespace softform::testing {
namespace {

class LuneSphere : public ::testing::Test {
 protected:
  LuneSphere()
  {
    // kappa h = 200 p x size, a residual of 2e-3 p x size.
    inflation.material = std::make_shared<TensionField>(4e5, 0.05, 1e-5);
    inflation.thickness = 1e-3;
    inflation.pressure = 1;
    options.stop.max_iterations = 12;
    start = inflated_panels(three_lune_sphere(1, 5), inflation);
  }

  double mean_distance(const InflatedPanels& panels) const
  {
    return sampled_distance(skin_mesh(panels.layout, panels.x), target.distance(), 5000).mean / target.size();
  }

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
  EXPECT_GT(triangle_quality(optimum.panels.layout).minCoeff(), 0);
}

// Every iterate is the inflated shape of its panels, and on one mesh the objective only falls.
TEST_F(LuneSphere, EveryIterateIsADesign)
{
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
