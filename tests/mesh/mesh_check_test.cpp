#include "softform/mesh/check.hpp"

#include <cmath>
#include <functional>
#include <limits>

#include <gtest/gtest.h>

#include "softform/mesh/self_intersections.hpp"
#include "softform/mesh/shapes.hpp"
#include "support/expect_input_error.hpp"
#include "support/meshes.hpp"

namespace softform {
namespace {

using Kind = MeshProblemKind;

TriangleMesh with(TriangleMesh mesh, const std::function<void(TriangleMesh&)>& change)
{
  change(mesh);
  return mesh;
}

TriangleMesh without_triangle(TriangleMesh mesh)
{
  mesh.triangles.conservativeResize(mesh.triangles.rows() - 1, 3);
  return mesh;
}

TriangleMesh with_triangle(TriangleMesh mesh, const Eigen::RowVector3i& triangle)
{
  mesh.triangles.conservativeResize(mesh.triangles.rows() + 1, 3);
  mesh.triangles.bottomRows<1>() = triangle;
  return mesh;
}

TriangleMesh with_vertex(TriangleMesh mesh, const Eigen::RowVector3d& vertex)
{
  mesh.vertices.conservativeResize(mesh.vertices.rows() + 1, 3);
  mesh.vertices.bottomRows<1>() = vertex;
  return mesh;
}

/// Two tetrahedra that share vertex 0 and nothing else.
TriangleMesh touching_tetrahedra()
{
  return test::make_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}},
                         {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}, {0, 4, 5}, {0, 6, 4}, {4, 6, 5}, {0, 5, 6}});
}

/// Two tetrahedra on either side of the edge 0-1.
TriangleMesh hinged_tetrahedra()
{
  return test::make_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, -1, 0}, {0, 0, -1}},
                         {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}, {0, 4, 1}, {0, 1, 5}, {1, 4, 5}, {0, 5, 4}});
}

/// A torus of n x m quadrangles, each split in two.
TriangleMesh torus(int n, int m)
{
  TriangleMesh mesh;
  mesh.vertices.resize(n * m, 3);
  mesh.triangles.resize(2 * n * m, 3);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < m; ++j) {
      const double u = 2 * M_PI * i / n, v = 2 * M_PI * j / m, r = 2 + std::cos(v);
      mesh.vertices.row(i * m + j) << r * std::cos(u), r * std::sin(u), std::sin(v);
      const int a = i * m + j, b = (i + 1) % n * m + j, c = (i + 1) % n * m + (j + 1) % m, d = i * m + (j + 1) % m;
      mesh.triangles.row(2 * a) << a, b, c;
      mesh.triangles.row(2 * a + 1) << a, c, d;
    }
  }
  return mesh;
}

struct Case {
  const char* name;
  TriangleMesh mesh;
  Kind kind;
  std::vector<std::string> message;
};

class BadMesh : public ::testing::TestWithParam<Case> {};

TEST_P(BadMesh, is_found_and_named)
{
  const auto& [name, mesh, kind, message] = GetParam();
  const MeshReport report = check_mesh(mesh);
  ASSERT_FALSE(report.usable());
  EXPECT_EQ(report.problems.front().kind, kind) << report.problems.front().message;
  auto texts = message;
  texts.push_back("thing.off");
  test::expect_input_error([&, &mesh = mesh] { require_closed_surface(mesh, "thing.off"); }, texts);
}

const double nan_value = std::numeric_limits<double>::quiet_NaN();
const Case cases[] = {
    {"empty", TriangleMesh{Positions(0, 3), Triangles(0, 3)}, Kind::TooFewTriangles, {"0 triangles"}},
    {"single_triangle",
     test::make_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}),
     Kind::TooFewTriangles,
     {"1 triangles", "closed surface"}},
    {"nan",
     with(sphere(1, 50), [](TriangleMesh& m) { m.vertices(17, 2) = nan_value; }),
     Kind::NotFinite,
     {"vertex 17", "not finite"}},
    {"infinite",
     with(sphere(1, 50), [](TriangleMesh& m) { m.vertices(3, 0) = INFINITY; }),
     Kind::NotFinite,
     {"vertex 3"}},
    {"unused_vertex", with_vertex(test::tetrahedron(), {5, 5, 5}), Kind::UnusedVertex, {"vertex 4", "loose"}},
    {"degenerate",
     with(sphere(1, 50),
          [](TriangleMesh& m) { m.vertices.row(m.triangles(9, 1)) = m.vertices.row(m.triangles(9, 0)); }),
     Kind::DegenerateTriangle,
     {"no area", "merge"}},
    {"repeated_corner", with_triangle(test::tetrahedron(), {1, 1, 2}), Kind::DegenerateTriangle, {"triangle 4"}},
    {"duplicate", with_triangle(test::tetrahedron(), {2, 3, 1}), Kind::DuplicateTriangle, {"triangles 2 and 4"}},
    {"open", without_triangle(sphere(1, 50)), Kind::OpenEdge, {"is open", "(3 such)", "fill the hole"}},
    {"fin",
     with_triangle(with_vertex(test::tetrahedron(), {-1, -1, -1}), {0, 1, 4}),
     Kind::NonManifoldEdge,
     {"edge 0-1", "3 triangles"}},
    {"hinge", hinged_tetrahedra(), Kind::NonManifoldEdge, {"edge 0-1", "4 triangles"}},
    {"touching", touching_tetrahedra(), Kind::NonManifoldVertex, {"vertex 0", "split"}},
    {"one_flipped",
     with(sphere(1, 50), [](TriangleMesh& m) { std::swap(m.triangles(20, 0), m.triangles(20, 1)); }),
     Kind::InconsistentOrientation,
     {"triangles 19 and 20", "opposite sides"}},
    {"inverted",
     with(sphere(1, 50), [](TriangleMesh& m) { m.triangles.col(0).swap(m.triangles.col(1)); }),
     Kind::InvertedOrientation,
     {"face inwards", "flip"}},
    {"two_parts", test::joined(sphere(1, 50), sphere(1, 50), {3, 0, 0}), Kind::SeveralComponents, {"2 separate parts"}},
    {"pierced",
     with(sphere(1, 200), [](TriangleMesh& m) { m.vertices.row(0) *= -1.5; }),
     Kind::SelfIntersection,
     {"cut each other", "triangles"}},
};
INSTANTIATE_TEST_SUITE_P(All, BadMesh, ::testing::ValuesIn(cases),
                         [](const auto& parameter) { return parameter.param.name; });

TEST(CheckMesh, describes_a_good_sphere)
{
  const MeshReport report = check_mesh(sphere(1, 500));
  EXPECT_TRUE(report.usable());
  EXPECT_EQ(report.vertices, 500);
  EXPECT_EQ(report.triangles, 996);
  EXPECT_EQ(report.edges, 1494);
  EXPECT_EQ(report.components, 1);
  EXPECT_EQ(report.genus, 0);
  EXPECT_EQ(report.self_intersections, 0);
  EXPECT_NEAR(report.volume, 4 * M_PI / 3, 0.07);
  EXPECT_GT(report.smallest_angle, 30);
  EXPECT_LT((report.upper_corner - Vec3(1, 1, 1)).cwiseAbs().maxCoeff(), 0.01);
  EXPECT_TRUE(report.notes.empty());
}

TEST(CheckMesh, notes_tunnels_and_slivers_without_refusing_them)
{
  const MeshReport ring = check_mesh(torus(20, 12));
  EXPECT_TRUE(ring.usable());
  EXPECT_EQ(ring.genus, 1);
  ASSERT_EQ(ring.notes.size(), 1u);
  EXPECT_NE(ring.notes[0].find("genus 1"), std::string::npos);

  TriangleMesh flat = sphere(1, 100);
  flat.vertices.col(2) *= 0.01;
  const MeshReport thin = check_mesh(flat);
  EXPECT_TRUE(thin.usable());
  EXPECT_LT(thin.smallest_angle, 10);
  EXPECT_EQ(thin.notes.size(), 1u);
}

TEST(SelfIntersections, names_pairs_of_two_tetrahedra_that_overlap)
{
  const TriangleMesh apart = test::joined(test::tetrahedron(), test::tetrahedron(), {2, 0, 0});
  EXPECT_EQ(count_self_intersections(apart), 0);
  const TriangleMesh overlapping = test::joined(test::tetrahedron(), test::tetrahedron(), {0.25, 0.25, 0.25});
  const auto pairs = self_intersections(overlapping);
  ASSERT_FALSE(pairs.empty());
  for (const auto& [a, b] : pairs) {
    EXPECT_LT(a, 4);
    EXPECT_GE(b, 4);
  }
  // Only the slanted side (2) of the first is reached by the second, whose three sides at its corner go through it.
  EXPECT_EQ(pairs, (std::vector<std::pair<int, int>>{{2, 4}, {2, 5}, {2, 7}}));
}

}  // namespace
}  // namespace softform
