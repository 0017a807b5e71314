#include "softform/inflatables/cut_panels.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "softform/io/datasets.hpp"
#include "softform/mesh/check.hpp"
#include "softform/mesh/relax.hpp"
#include "softform/mesh/shapes.hpp"
#include "support/expect_input_error.hpp"

namespace softform {
namespace {

const Geodesics& ball()
{
  static const Geodesics geodesics(sphere(1, 4000));
  return geodesics;
}

TriangleMesh coarse_ball() { return irregular_sphere(1, 348); }

SeamPlan three_lunes() { return read_seam_file(default_manifest().parent_path() / "seams" / "sphere.json"); }

Vec3 on_sphere(double latitude, double longitude)
{
  return {std::cos(latitude) * std::cos(longitude), std::cos(latitude) * std::sin(longitude), std::sin(latitude)};
}

DrawnSeam parallel(const std::string& name, double latitude)
{
  DrawnSeam seam{name, 1, true, {}};
  for (int i = 0; i < 6; ++i) seam.points.push_back({on_sphere(latitude, i * std::numbers::pi / 3), {}, {}});
  return seam;
}

TEST(CutPanels, SphereInThreeLunes)
{
  const TriangleMesh mesh = coarse_ball();
  const PanelLayout layout = cut_into_panels(mesh, ball(), three_lunes());
  EXPECT_EQ(layout.triangle_count(), 692);  // as in the thesis' table 6.2
  EXPECT_EQ(layout.node_count(), 348);
  const TriangleMesh sewn{layout.nodes, node_triangles(layout)};
  EXPECT_TRUE(check_mesh(sewn).usable());
  EXPECT_GT(smallest_quality(flatten(layout.nodes), sewn.triangles), 0.4);
  ASSERT_EQ(layout.panels.size(), 3U);
  for (const Panel& panel : layout.panels) EXPECT_EQ(panel.name.substr(0, 5), "lune ");
  // A lune of a third of the sphere has a third of its area.
  for (int p = 0; p < 3; ++p) {
    const TriangleMesh lune = panel_mesh(layout, p);
    EXPECT_NEAR(surface_area(flatten(lune.vertices), lune.triangles), 4 * std::numbers::pi / 3, 0.06);
  }
}

TEST(CutPanels, SeamVerticesLieOnTheirMeridiansAtEqualDistances)
{
  const PanelLayout layout = cut_into_panels(coarse_ball(), ball(), three_lunes());
  ASSERT_EQ(layout.seams.size(), 3U);
  for (std::size_t s = 0; s < 3; ++s) {
    const double longitude = 2 * std::numbers::pi * static_cast<double>(s) / 3;
    const Vec3 across(-std::sin(longitude), std::cos(longitude), 0);
    const auto& vertices = layout.seams[s].sides[0].vertices;
    for (std::size_t k = 0; k < vertices.size(); ++k) {
      const Vec3 p = layout.nodes.row(layout.node_of[static_cast<std::size_t>(vertices[k])]);
      EXPECT_NEAR(p.dot(across), 0, 0.01);
      const double polar = std::numbers::pi * static_cast<double>(k) / static_cast<double>(vertices.size() - 1);
      EXPECT_NEAR(std::acos(p.z() / p.norm()), polar, 0.01);
    }
  }
}

TEST(CutPanels, IsTheSameEveryTime)
{
  const PanelLayout a = cut_into_panels(coarse_ball(), ball(), three_lunes());
  const PanelLayout b = cut_into_panels(coarse_ball(), ball(), three_lunes());
  EXPECT_EQ(a.nodes, b.nodes);
  EXPECT_EQ(a.triangles, b.triangles);
}

TEST(CutPanels, APanelWithAHoleIsRefusedAndItsCureWorks)
{
  SeamPlan plan{"test.json", {parallel("north", 0.5), parallel("south", -0.5)}, {}, {{"belt", {1, 0, 0}}}};
  test::expect_input_error([&] { cut_into_panels(coarse_ball(), ball(), plan); },
                           {"test.json", "panel 'belt'", "hole", "'north'", "'south'", "a seam from ("});
  plan.seams.push_back({"belt seam", 1, false, {{on_sphere(0.5, 1), "north", {}}, {on_sphere(-0.5, 1), "south", {}}}});
  EXPECT_EQ(cut_into_panels(coarse_ball(), ball(), plan).panels.size(), 3U);
}

TEST(CutPanels, ASlitInsideAPanelIsAHole)
{
  SeamPlan plan{"test.json", {parallel("equator", 0)}, {}, {}};
  plan.seams.push_back({"slit", 1, false, {{on_sphere(1.3, 0), {}, {}}, {on_sphere(1.3, std::numbers::pi), {}, {}}}});
  test::expect_input_error([&] { cut_into_panels(coarse_ball(), ball(), plan); }, {"hole", "'equator'", "'slit'"});
}

TEST(CutPanels, NamesHaveAPanelEach)
{
  SeamPlan plan = three_lunes();
  plan.panels[1].inside = plan.panels[0].inside + Vec3(0, 0, 0.1);
  test::expect_input_error([&] { cut_into_panels(coarse_ball(), ball(), plan); }, {"'lune 2'", "'lune 1'", "names"});
}

TEST(CutPanels, SeamsTooCloseForTheMeshAreRefused)
{
  SeamPlan plan{"test.json", {parallel("a", 0), parallel("b", 0.05), parallel("c", 0.1)}, {}, {}};
  test::expect_input_error([&] { cut_into_panels(coarse_ball(), ball(), plan); },
                           {"test.json", "move", "apart", "more vertices"});
}

}  // namespace
}  // namespace softform
