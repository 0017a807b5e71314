#include "softform/inflatables/panel_layout.hpp"

#include <cmath>
#include <numbers>
#include <set>

#include <gtest/gtest.h>

#include "softform/mesh/check.hpp"
#include "support/meshes.hpp"

namespace softform {
namespace {

double flat_area(const PanelLayout& layout, int triangle)
{
  const auto corner = [&](int k) -> Eigen::Vector2d { return layout.flat.row(layout.triangles(triangle, k)); };
  const Eigen::Vector2d a = corner(1) - corner(0), b = corner(2) - corner(0);
  return 0.5 * (a.x() * b.y() - a.y() * b.x());
}

double flat_area(const PanelLayout& layout)
{
  double area = 0;
  for (int t = 0; t < layout.triangle_count(); ++t) area += flat_area(layout, t);
  return area;
}

TEST(PanelLayout, ThreeLunesAreAClosedSphereInThreeDiscs)
{
  const PanelLayout layout = three_lune_sphere(2, 11);
  EXPECT_EQ(layout.triangle_count(), 726);
  EXPECT_TRUE(check_mesh({layout.nodes, node_triangles(layout)}).usable());
  ASSERT_EQ(layout.panels.size(), 3U);
  for (int p = 0; p < 3; ++p) {
    const TriangleMesh mesh = panel_mesh(layout, p);
    EXPECT_EQ(mesh.triangle_count(), 242);
    const auto edges = static_cast<int>(edges_of(mesh.triangles, mesh.vertex_count()).size());
    EXPECT_EQ(mesh.vertex_count() - edges + mesh.triangle_count(), 1);
    const auto loops = boundary_loops(layout, p);
    ASSERT_EQ(loops.size(), 1U);
    EXPECT_EQ(loops[0].size(), 44U);
  }
}

TEST(PanelLayout, SeamSidesShareTheirNodesAndTheirLengths)
{
  const PanelLayout layout = three_lune_sphere(2, 11);
  ASSERT_EQ(layout.seams.size(), 3U);
  for (const Seam& seam : layout.seams) {
    ASSERT_EQ(seam.sides.size(), 2U);
    ASSERT_EQ(seam.sides[0].vertices.size(), 23U);
    ASSERT_EQ(seam.sides[1].vertices.size(), 23U);
    for (std::size_t k = 0; k < 23; ++k) {
      const auto left = static_cast<std::size_t>(seam.sides[0].vertices[k]);
      const auto right = static_cast<std::size_t>(seam.sides[1].vertices[k]);
      EXPECT_NE(left, right);
      EXPECT_EQ(layout.node_of[left], layout.node_of[right]);
    }
    const auto lengths = side_lengths(layout, seam);
    EXPECT_NEAR(lengths[0], lengths[1], 1e-12);
  }
  // Meridian 0 runs from the north pole with the first lune on its left, seen from outside, and the third on its right.
  EXPECT_EQ(layout.seams[0].sides[0].panel, 0);
  EXPECT_EQ(layout.seams[0].sides[1].panel, 2);
}

TEST(PanelLayout, MismatchIsRelativeToTheMeanOfBothSides)
{
  PanelLayout layout = three_lune_sphere(2, 11);
  EXPECT_LT(seam_mismatch(layout).max, 1e-14);
  const Panel& lune = layout.panels[0];  // on one side of two of the three seams
  layout.flat.middleRows(lune.first_vertex, lune.vertex_count) *= 1.5;
  const SeamMismatch mismatch = seam_mismatch(layout);
  EXPECT_NEAR(mismatch.max, 0.5 / 1.25, 1e-14);
  EXPECT_NEAR(mismatch.mean, 2.0 / 3 * 0.5 / 1.25, 1e-14);
}

TEST(PanelLayout, TheSkinLeavesWallsOut)
{
  PanelLayout layout = three_lune_sphere(2, 11);
  layout.panels[2].is_wall = true;
  const TriangleMesh skin = skin_mesh(layout, flatten(layout.nodes));
  EXPECT_EQ(skin.triangle_count(), 2 * 242);
  EXPECT_EQ(skin.vertices, layout.nodes);
}

TEST(PanelLayout, SinusoidalDevelopmentKeepsAreaToSecondOrder)
{
  const double exact = 4 * std::numbers::pi;
  const double coarse = std::abs(flat_area(three_lune_sphere(1, 8)) - exact);
  const double fine = std::abs(flat_area(three_lune_sphere(1, 16)) - exact);
  EXPECT_NEAR(std::log2(coarse / fine), 2, 0.1);
  const PanelLayout layout = three_lune_sphere(1, 8);
  for (int t = 0; t < layout.triangle_count(); ++t) EXPECT_GT(flat_area(layout, t), 0);
}

TEST(PanelLayout, ADartLeavesOnePanelSewnToItself)
{
  const TriangleMesh mesh = test::tetrahedron();
  const PanelLayout layout = split_along(mesh, {{"dart", 2, {0, 1, 2}}});
  ASSERT_EQ(layout.panels.size(), 1U);
  EXPECT_EQ(layout.vertex_count(), 5);  // vertex 1 twice, the tips once
  ASSERT_EQ(layout.seams.size(), 1U);
  const Seam& seam = layout.seams[0];
  EXPECT_EQ(seam.weight, 2);
  EXPECT_EQ(seam.sides[0].panel, seam.sides[1].panel);
  EXPECT_EQ(seam.sides[0].vertices.front(), seam.sides[1].vertices.front());
  EXPECT_NE(seam.sides[0].vertices[1], seam.sides[1].vertices[1]);
  const auto loops = boundary_loops(layout, 0);
  ASSERT_EQ(loops.size(), 1U);
  EXPECT_EQ(loops[0].size(), 4U);
}

TEST(PanelLayout, AClosedSeamEndsWhereItBegins)
{
  const PanelLayout layout = split_along(test::tetrahedron(), {{"ring", 0, {1, 2, 3, 1}}});
  ASSERT_EQ(layout.panels.size(), 2U);
  for (const SeamSide& side : layout.seams[0].sides) EXPECT_EQ(side.vertices.front(), side.vertices.back());
  EXPECT_NE(layout.seams[0].sides[0].panel, layout.seams[0].sides[1].panel);
}

}  // namespace
}  // namespace softform
