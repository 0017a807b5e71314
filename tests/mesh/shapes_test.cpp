#include "softform/mesh/shapes.hpp"

#include <array>
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "softform/mesh/check.hpp"
#include "softform/mesh/distance.hpp"
#include "softform/mesh/remesh.hpp"
#include "support/expect_input_error.hpp"
#include "support/meshes.hpp"

namespace softform {
namespace {

struct Shape {
  const char* name;
  TriangleMesh (*make)(double, int);
  int vertices;
  double (*distance)(const Vec3&);  ///< of a point from the exact surface of size 2
};

double from_sphere(const Vec3& p) { return std::abs(p.norm() - 2); }
double from_cube(const Vec3& p) { return std::abs(p.cwiseAbs().maxCoeff() - 1); }
double from_bumpsphere(const Vec3& p) { return std::abs(p.norm() - 2 * bumpsphere_radius(p)); }

class Shapes : public ::testing::TestWithParam<Shape> {};

TEST_P(Shapes, are_exact_closed_and_well_shaped)
{
  const Shape& shape = GetParam();
  const TriangleMesh mesh = shape.make(2, shape.vertices);
  const MeshReport report = check_mesh(mesh);
  for (const MeshProblem& problem : report.problems) ADD_FAILURE() << problem.message;
  EXPECT_EQ(report.vertices, shape.vertices);
  EXPECT_EQ(report.genus, 0);
  EXPECT_GT(report.smallest_angle, 20);
  for (int i = 0; i < mesh.vertex_count(); ++i)
    ASSERT_LT(shape.distance(mesh.vertices.row(i)), 1e-12) << "vertex " << i;

  const TriangleMesh again = shape.make(2, shape.vertices);
  EXPECT_EQ(again.vertices, mesh.vertices);
  EXPECT_EQ(again.triangles, mesh.triangles);
}

INSTANTIATE_TEST_SUITE_P(All, Shapes,
                         ::testing::Values(Shape{"sphere_12", sphere, 12, from_sphere},
                                           Shape{"sphere_348", sphere, 348, from_sphere},
                                           Shape{"irregular_sphere_100", irregular_sphere, 100, from_sphere},
                                           Shape{"irregular_sphere_1001", irregular_sphere, 1001, from_sphere},
                                           Shape{"cube_200", cube, 200, from_cube},
                                           Shape{"cube_1200", cube, 1200, from_cube},
                                           Shape{"cube_5153", cube, 5153, from_cube},
                                           Shape{"bumpsphere_1000", bumpsphere, 1000, from_bumpsphere},
                                           Shape{"bumpsphere_3265", bumpsphere, 3265, from_bumpsphere}),
                         [](const auto& parameter) { return parameter.param.name; });

TEST(Shapes, refuse_too_few_vertices)
{
  test::expect_input_error([] { sphere(1, 11); }, {"11 vertices", "at least 12"});
  test::expect_input_error([] { cube(1, 8); }, {"8 vertices", "at least 200"});
  test::expect_input_error([] { bumpsphere(1, 100); }, {"100 vertices", "at least 1000"});
}

TEST(Cube, keeps_corners_and_edges)
{
  const TriangleMesh mesh = cube(1, 1200);
  // Every vertex exactly on the surface, the volume is exact only if no triangle spans an edge or corner.
  EXPECT_NEAR(enclosed_volume(mesh), 1, 1e-12);
  EXPECT_NEAR(surface_area(flatten(mesh.vertices), mesh.triangles), 6, 1e-12);
  std::set<std::array<double, 3>> corners;
  for (int i = 0; i < mesh.vertex_count(); ++i)
    if ((mesh.vertices.row(i).cwiseAbs().array() == 0.5).all())
      corners.insert({mesh.vertices(i, 0), mesh.vertices(i, 1), mesh.vertices(i, 2)});
  EXPECT_EQ(corners.size(), 8u);
}

TEST(Bumpsphere, has_twelve_bumps_on_a_sphere)
{
  const double golden = (1 + std::sqrt(5.0)) / 2;
  EXPECT_NEAR(bumpsphere_radius({0, 1, golden}), 1.15, 1e-12);
  EXPECT_NEAR(bumpsphere_radius({0, -1, golden}), 1.15, 1e-12);
  EXPECT_NEAR(bumpsphere_radius({golden, 0, 1}), 1.15, 1e-12);
  EXPECT_NEAR(bumpsphere_radius({1, 1, 1}), 1, 1e-12);  // the middle of a face of the icosahedron
}

TEST(Remesh, puts_an_exact_count_on_the_surface_of_the_input)
{
  TriangleMesh egg = sphere(1, 3000);
  egg.vertices.col(2) *= 1.6;
  const TriangleMesh mesh = remesh_to_vertex_count(egg, 777);
  const MeshReport report = check_mesh(mesh);
  EXPECT_TRUE(report.usable());
  EXPECT_EQ(report.vertices, 777);
  EXPECT_EQ(report.genus, 0);
  EXPECT_GT(report.smallest_angle, 20);
  EXPECT_LT(SurfaceDistance(egg).distances(mesh.vertices).maxCoeff(), 1e-12);
  EXPECT_NEAR(report.volume, enclosed_volume(egg), 0.02 * report.volume);
}

TEST(Remesh, refuses_a_surface_that_is_not_closed)
{
  TriangleMesh open = sphere(1, 200);
  open.triangles.conservativeResize(390, 3);
  test::expect_input_error([&] { remesh_to_vertex_count(open, 150); }, {"genus 0"});
}

TEST(Repair, closes_and_orients_a_soup)
{
  TriangleMesh soup = sphere(1, 300);
  soup.triangles.conservativeResize(590, 3);                                               // a hole
  for (int t = 0; t < 590; t += 3) std::swap(soup.triangles(t, 0), soup.triangles(t, 1));  // flipped triangles
  soup = test::joined(soup, sphere(0.1, 20), {5, 0, 0});                                   // a second part
  ASSERT_FALSE(check_mesh(soup).usable());

  const MeshReport report = check_mesh(repaired(soup));
  for (const MeshProblem& problem : report.problems) ADD_FAILURE() << problem.message;
  EXPECT_EQ(report.genus, 0);
  EXPECT_NEAR(report.volume, enclosed_volume(sphere(1, 300)), 0.02);
}

TEST(ShrinkWrap, closes_a_tunnel)
{
  // A ring of eight balls around a hole that the ball of radius alpha does not pass.
  TriangleMesh ring = sphere(0.5, 100);
  ring.vertices.col(0).array() += 1;
  TriangleMesh all = ring;
  for (int i = 1; i < 8; ++i) {
    TriangleMesh turned = ring;
    const double angle = M_PI / 4 * i;
    turned.vertices.col(0) = std::cos(angle) * ring.vertices.col(0) - std::sin(angle) * ring.vertices.col(1);
    turned.vertices.col(1) = std::sin(angle) * ring.vertices.col(0) + std::cos(angle) * ring.vertices.col(1);
    all = test::joined(all, turned, Vec3::Zero());
  }
  EXPECT_EQ(check_mesh(shrink_wrapped(all, 1.0, 0.05)).genus, 0);
  EXPECT_EQ(check_mesh(shrink_wrapped(all, 0.2, 0.02)).genus, 1);
}

}  // namespace
}  // namespace softform
