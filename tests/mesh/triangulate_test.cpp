#include "softform/mesh/triangulate.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "softform/mesh/polygon.hpp"
#include "support/expect_input_error.hpp"

namespace softform {
namespace {

// A regular polygon's corners on a circle, as smooth points.
OutlineLoop round_loop(double radius, int points)
{
  OutlineLoop loop;
  for (int i = 0; i < points; ++i) {
    const double angle = 2 * std::numbers::pi * i / points;
    loop.push_back({radius * Eigen::Vector2d(std::cos(angle), std::sin(angle)), false});
  }
  return loop;
}

OutlineLoop square(double half)
{
  return {{{-half, -half}, true}, {{half, -half}, true}, {{half, half}, true}, {{-half, half}, true}};
}

double area(const PlanarMesh& mesh)
{
  double sum = 0;
  for (int t = 0; t < mesh.element_count(); ++t) sum += doubled_area(mesh.positions, mesh.elements, t) / 2;
  return sum;
}

double smallest_angle(const PlanarMesh& mesh)
{
  double smallest = 180;
  for (int t = 0; t < mesh.element_count(); ++t)
    for (int k = 0; k < 3; ++k) {
      const Eigen::RowVector2d a = rows_of(mesh.positions).row(mesh.elements(t, k));
      const Eigen::RowVector2d u = rows_of(mesh.positions).row(mesh.elements(t, (k + 1) % 3)) - a;
      const Eigen::RowVector2d v = rows_of(mesh.positions).row(mesh.elements(t, (k + 2) % 3)) - a;
      smallest = std::min(smallest, std::acos(u.normalized().dot(v.normalized())) * 180 / std::numbers::pi);
    }
  return smallest;
}

TEST(Sample, is_equally_spaced_and_keeps_corners)
{
  const PlanarPositions points = sample(square(1), 0.3);
  ASSERT_EQ(points.rows(), 4 * 7);
  EXPECT_NEAR(signed_area(points), 4, 1e-12);
  for (Eigen::Index i = 0; i < points.rows(); ++i)
    EXPECT_NEAR((points.row((i + 1) % points.rows()) - points.row(i)).norm(), 2.0 / 7, 1e-12);
}

TEST(Sample, of_a_round_loop_converges_to_the_circle_with_third_order_or_better)
{
  const auto error = [](int points) {
    double worst = 0;
    const auto samples = sample(round_loop(1, points), 1e-3);  // outlives the loop
    for (const auto& p : samples.rowwise()) worst = std::max(worst, std::abs(p.norm() - 1));
    return worst;
  };
  EXPECT_GT(std::log2(error(8) / error(16)), 2.9);
}

TEST(Triangulate, covers_the_region_with_good_triangles)
{
  const std::vector<PlanarPositions> polygons{sample(square(1), 0.1), sample(square(0.5), 0.1)};
  const PlanarMesh mesh = triangulate(polygons, 0.1);
  EXPECT_NEAR(area(mesh), 4 - 1, 1e-12);
  EXPECT_GT(smallest_angle(mesh), 20);
  EXPECT_GT(rows_of(mesh.positions).rowwise().lpNorm<Eigen::Infinity>().minCoeff(), 0.5 - 1e-12);
}

TEST(Triangulate, reaches_a_count)
{
  for (const int count : {300, 1000, 2500}) {
    const PlanarMesh mesh = triangulate_to_count({round_loop(0.1, 12), round_loop(0.04, 8)}, count);
    EXPECT_NEAR(mesh.element_count(), count, 0.01 * count);
    EXPECT_GT(smallest_angle(mesh), 20);
  }
}

// Vertices were once moved in the order of their addresses: two runs of a program had two meshes.
TEST(Triangulate, gives_the_same_mesh_whatever_the_heap_looks_like)
{
  const std::vector<PlanarPositions> outline{sample(round_loop(0.1, 12), 0.004)};
  const PlanarMesh first = triangulate(outline, 0.004);
  // Holes of all sizes that later blocks may fall into, high addresses before low ones.
  std::vector<std::vector<char>> blocks;
  for (std::size_t size = 1u << 17; size > 1u << 9; size = size * 9 / 10) blocks.emplace_back(size);
  for (std::size_t k = 0; k < blocks.size(); k += 2) std::vector<char>().swap(blocks[k]);
  const PlanarMesh second = triangulate(outline, 0.004);
  EXPECT_EQ(first.elements, second.elements);
  EXPECT_EQ(first.positions, second.positions);
}

TEST(Triangulate, refuses_outlines_that_enclose_nothing_or_cross)
{
  const OutlineLoop line{{{0, 0}, true}, {{1, 0}, true}, {{2, 0}, true}};
  test::expect_input_error([&] { triangulate({sample(line, 1)}, 1); }, {"loop 0", "no area"});
  const OutlineLoop eight{{{0, 0}, true}, {{2, 2}, true}, {{2, 0}, true}, {{0, 1}, true}};
  test::expect_input_error([&] { triangulate({sample(eight, 10)}, 1); }, {"crosses itself"});
}

TEST(TriangulateInside, keeps_the_corners_first_and_the_boundary_undivided)
{
  for (const int arms : {0, 3, 5, 9}) {  // a disc and stars with more and more concave corners
    PlanarPositions polygon(180, 2);
    for (int i = 0; i < 180; ++i) {
      const double angle = 2 * std::numbers::pi * i / 180, radius = 1 + (arms > 0 ? 0.4 : 0) * std::cos(arms * angle);
      polygon.row(i) << radius * std::cos(angle), radius * std::sin(angle);
    }
    const double edge = perimeter(polygon) / 180;
    const PlanarMesh mesh = triangulate_inside(polygon, edge);
    EXPECT_EQ(rows_of(mesh.positions).topRows(180), polygon);
    const BoundaryFaces<2> boundary = boundary_faces<2>(mesh.elements);
    EXPECT_EQ(boundary.faces.rows(), 180);
    EXPECT_LT(boundary.faces.maxCoeff(), 180);
    EXPECT_NEAR(area(mesh), signed_area(polygon), 1e-12);
    EXPECT_GT(smallest_angle(mesh), 20);
    EXPECT_NEAR(mesh.element_count() * std::sqrt(3.0) / 4 * edge * edge / signed_area(polygon), 1, 0.15);
  }
}

TEST(TriangulateInside, a_triangle_is_one)
{
  PlanarPositions polygon(3, 2);
  polygon << 0, 0, 1, 0, 0.5, 0.8;
  const PlanarMesh mesh = triangulate_inside(polygon, 1);
  EXPECT_EQ(mesh.element_count(), 1);
  EXPECT_EQ(mesh.vertex_count(), 3);
}

}  // namespace
}  // namespace softform
