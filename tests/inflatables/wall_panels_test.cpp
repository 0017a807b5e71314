#include "softform/inflatables/wall_panels.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "softform/inflatables/cut_panels.hpp"
#include "softform/inflatables/flatten.hpp"
#include "softform/mesh/polygon_mesh.hpp"
#include "softform/mesh/relax.hpp"
#include "softform/mesh/shapes.hpp"
#include "support/expect_input_error.hpp"

namespace softform {
namespace {

/// Half circles from pole to pole at two longitudes, and the wall between them.
SeamPlan meridians(double longitude)
{
  SeamPlan plan{"test.json", {}, {{"wall", {"a", "b"}}}, {}};
  for (const auto& [name, angle] : {std::pair{"a", 0.0}, {"b", longitude}})
    plan.seams.push_back(
        {name, 1, false, {{{0, 0, 1}, {}, {}}, {{std::cos(angle), std::sin(angle), 0}, {}, {}}, {{0, 0, -1}, {}, {}}}});
  return plan;
}

PanelLayout cut(const SeamPlan& plan)
{
  return cut_into_panels(irregular_sphere(1, 400), Geodesics(sphere(1, 4000)), plan);
}

double flat_area(const PanelLayout& layout, const Panel& panel)
{
  double area = 0;
  for (int t = panel.first_triangle; t < panel.first_triangle + panel.triangle_count; ++t) {
    const Eigen::RowVector2d a = layout.flat.row(layout.triangles(t, 1)) - layout.flat.row(layout.triangles(t, 0));
    const Eigen::RowVector2d b = layout.flat.row(layout.triangles(t, 2)) - layout.flat.row(layout.triangles(t, 0));
    EXPECT_GT(a[0] * b[1] - a[1] * b[0], 0);
    area += 0.5 * (a[0] * b[1] - a[1] * b[0]);
  }
  return area;
}

TEST(WallPanels, ADiaphragmIsADisc)
{
  const PanelLayout layout = cut(meridians(std::numbers::pi));
  ASSERT_EQ(layout.panels.size(), 3U);
  const Panel& wall = layout.panels[2];
  EXPECT_TRUE(wall.is_wall);
  EXPECT_EQ(wall.name, "wall");
  EXPECT_EQ(boundary_loops(layout, 2).size(), 1U);
  EXPECT_NEAR(flat_area(layout, wall), std::numbers::pi, 0.03);  // of the unit disc
  // It lies in the plane y = 0, and flat it is as it is in space.
  const TriangleMesh mesh = panel_mesh(layout, 2);
  EXPECT_LT(mesh.vertices.col(1).cwiseAbs().maxCoeff(), 0.02);
  EXPECT_NEAR(surface_area(flatten(mesh.vertices), mesh.triangles), flat_area(layout, wall), 2e-3);
  EXPECT_GT(smallest_quality(flatten(mesh.vertices), mesh.triangles), 0.3);
}

TEST(WallPanels, SeamsGetAThirdSideOnTheSameNodes)
{
  PanelLayout layout = cut(meridians(2));
  flatten_panels(layout);
  ASSERT_EQ(layout.seams.size(), 2U);
  for (const Seam& seam : layout.seams) {
    ASSERT_EQ(seam.sides.size(), 3U);
    EXPECT_EQ(seam.sides[2].panel, 2);
    ASSERT_EQ(seam.sides[2].vertices.size(), seam.sides[0].vertices.size());
    for (std::size_t k = 0; k < seam.sides[0].vertices.size(); ++k)
      EXPECT_EQ(layout.node_of[static_cast<std::size_t>(seam.sides[2].vertices[k])],
                layout.node_of[static_cast<std::size_t>(seam.sides[0].vertices[k])]);
    double length = 0;  // on the target: a wall lies flat without stretch
    for (std::size_t k = 1; k < seam.sides[2].vertices.size(); ++k)
      length += (layout.nodes.row(layout.node_of[static_cast<std::size_t>(seam.sides[2].vertices[k])]) -
                 layout.nodes.row(layout.node_of[static_cast<std::size_t>(seam.sides[2].vertices[k - 1])]))
                    .norm();
    EXPECT_NEAR(side_lengths(layout, seam)[2] / length, 1, 2e-3);
  }
}

TEST(WallPanels, SeamsWithoutACommonEndLeaveFreeEdges)
{
  SeamPlan plan{"test.json", {}, {{"wall", {"a", "b"}}}, {}};
  for (const auto& [name, x] : {std::pair{"a", -0.5}, {"b", 0.5}})
    plan.seams.push_back(
        {name, 1, false, {{Vec3(x, -1, 1).normalized(), {}, {}}, {Vec3(x, 1, 1).normalized(), {}, {}}}});
  plan.seams.push_back({"c", 1, false, {{{}, "a", 1.0}, {{}, "b", 1.0}}});
  const PanelLayout layout = cut(plan);
  ASSERT_EQ(layout.panels.size(), 2U);
  const auto loop = boundary_loops(layout, 1).front();
  const std::size_t sewn = layout.seams[0].sides[2].vertices.size() + layout.seams[1].sides[2].vertices.size();
  EXPECT_GT(loop.size(), sewn);  // the free edges have vertices of their own
  EXPECT_GT(flat_area(layout, layout.panels[1]), 0.5);
}

TEST(WallPanels, WhatCannotBeAWallIsRefused)
{
  SeamPlan plan = meridians(std::numbers::pi);
  plan.seams.push_back({"ring", 1, true, {}});
  for (int i = 0; i < 6; ++i)
    plan.seams[2].points.push_back({Vec3(0.3 * std::cos(i), 0.9, 0.3 * std::sin(i)).normalized(), {}, {}});
  plan.seams.push_back({"link", 1, false, {{{}, "ring", 0.0}, {{1, 0, 0}, "a", {}}}});
  plan.walls[0].between[1] = "ring";
  test::expect_input_error([&] { cut(plan); }, {"wall 'wall'", "'ring' is closed", "halves"});

  SeamPlan crossing = meridians(std::numbers::pi);
  crossing.seams.push_back({"c", 1, false, {{{0, 0, 1}, {}, {}}, {{0, 1, 0}, {}, {}}, {{1, 0, 0}, "a", {}}}});
  crossing.walls[0].between[1] = "c";
  test::expect_input_error([&] { cut(crossing); }, {"wall 'wall'", "before their ends"});
}

TEST(PolygonMesh, KeepsTheOutlineAndCoversTheArea)
{
  PlanarPositions circle(40, 2);
  for (int i = 0; i < 40; ++i)
    circle.row(i) << std::cos(2 * std::numbers::pi * i / 40), std::sin(2 * std::numbers::pi * i / 40);
  const PlanarMesh mesh = triangulated_inside(circle, 0.157);
  EXPECT_EQ(mesh.vertices.topRows(40), circle);
  const auto loops = boundary_loops(mesh.triangles);
  ASSERT_EQ(loops.size(), 1U);
  EXPECT_EQ(loops[0].size(), 40U);  // no vertex was added to the outline
  Positions flat = Positions::Zero(mesh.vertices.rows(), 3);
  flat.leftCols(2) = mesh.vertices;
  EXPECT_NEAR(surface_area(flatten(flat), mesh.triangles), 20 * std::sin(2 * std::numbers::pi / 40), 1e-12);
  EXPECT_GT(smallest_quality(flatten(flat), mesh.triangles), 0.6);
  test::expect_input_error([&] { triangulated_inside(circle.colwise().reverse(), 0.1); }, {"clockwise"});
  PlanarPositions bow(4, 2);
  bow << 0, 0, 1, 1, 1, 0, 0, 1;
  test::expect_input_error([&] { triangulated_inside(bow, 0.1); }, {"crosses itself"});
}

}  // namespace
}  // namespace softform
