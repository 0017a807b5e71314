#include "softform/mesh/distance.hpp"

#include <limits>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "softform/mesh/alignment.hpp"
#include "softform/mesh/shapes.hpp"

namespace softform {
namespace {

/// The closest point of a triangle by its definition: the foot of the perpendicular when it is inside, else the
/// closest point of the three edges.
double triangle_distance(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c)
{
  const auto to_segment = [&p](const Vec3& u, const Vec3& v) {
    const double s = std::clamp((p - u).dot(v - u) / (v - u).squaredNorm(), 0.0, 1.0);
    return (u + s * (v - u) - p).norm();
  };
  const Vec3 n = (b - a).cross(c - a).normalized();
  const Vec3 foot = p - n.dot(p - a) * n;
  const bool inside =
      n.dot((b - a).cross(foot - a)) >= 0 && n.dot((c - b).cross(foot - b)) >= 0 && n.dot((a - c).cross(foot - c)) >= 0;
  return inside ? (foot - p).norm() : std::min({to_segment(a, b), to_segment(b, c), to_segment(c, a)});
}

TEST(SurfaceDistance, equals_brute_force)
{
  const TriangleMesh mesh = bumpsphere(1, 1000);
  const SurfaceDistance surface(mesh);
  std::srand(1);
  const Positions points = 1.5 * Positions::Random(200, 3);
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    const Vec3 p = points.row(i);
    double expected = std::numeric_limits<double>::infinity();
    const auto corner = [&](int t, int k) { return Vec3(mesh.vertices.row(mesh.triangles(t, k))); };
    for (int t = 0; t < mesh.triangle_count(); ++t)
      expected = std::min(expected, triangle_distance(p, corner(t, 0), corner(t, 1), corner(t, 2)));

    const ClosestPoint closest = surface.closest(p);
    EXPECT_NEAR(closest.distance, expected, 1e-12);
    EXPECT_NEAR((closest.position - p).norm(), expected, 1e-12);
    const int t = closest.triangle;
    EXPECT_NEAR(triangle_distance(closest.position, corner(t, 0), corner(t, 1), corner(t, 2)), 0, 1e-12);
  }
  // All rows at once, in parallel, give the same.
  const Vec distances = surface.distances(points);
  for (Eigen::Index i = 0; i < points.rows(); ++i) EXPECT_EQ(distances[i], surface.closest(points.row(i)).distance);
}

// Corners of a tetrahedron on the unit sphere: no distance at the vertices, 2/3 in the middle of its faces.
TEST(SampledDistance, sees_what_lies_between_vertices)
{
  TriangleMesh tetrahedron;
  tetrahedron.vertices.resize(4, 3);
  tetrahedron.vertices << 1, 1, 1, 1, -1, -1, -1, 1, -1, -1, -1, 1;
  tetrahedron.vertices /= std::sqrt(3.0);
  tetrahedron.triangles.resize(4, 3);
  tetrahedron.triangles << 0, 1, 2, 0, 3, 1, 0, 2, 3, 1, 3, 2;
  const SurfaceDistance ball(sphere(1, 20000));
  const ShapeDistance distance = sampled_distance(tetrahedron, ball);
  EXPECT_NEAR(distance.max, 2.0 / 3, 1e-3);
  // The mean of 1 - |p| over a face, by midpoints of a fine grid of triangles.
  double sum = 0;
  constexpr int n = 400;
  for (int i = 0; i < n; ++i)
    for (int k = 0; k + i < n; ++k) {
      const double u = (i + 1.0 / 3) / n, v = (k + 1.0 / 3) / n;
      const Eigen::RowVector3d p =
          (1 - u - v) * tetrahedron.vertices.row(0) + u * tetrahedron.vertices.row(1) + v * tetrahedron.vertices.row(2);
      sum += 1 - p.norm();
    }
  EXPECT_NEAR(distance.mean, sum / (n * (n + 1) / 2.0), 1e-3);
}

TEST(SurfaceDistance, converges_to_the_sphere)
{
  const Vec3 p(0.3, -0.2, 0.5);
  const SurfaceDistance surface(sphere(1, 20000));
  EXPECT_NEAR(surface.distance(p), 1 - p.norm(), 2e-4);
  EXPECT_NEAR(surface.distance(3 * p.normalized()), 2, 2e-4);
}

TEST(SampleSurface, is_even_by_area)
{
  // A face of the cube holds a sixth of the area: it must hold a sixth of the samples.
  const Positions samples = sample_surface(cube(1, 500), 6000);
  for (Eigen::Index axis = 0; axis < 3; ++axis)
    for (const double side : {-0.5, 0.5})
      EXPECT_NEAR(static_cast<double>(((samples.col(axis).array() - side).abs() < 1e-12).count()), 1000, 20);
  EXPECT_EQ(samples, sample_surface(cube(1, 500), 6000));
}

TEST(Hausdorff, of_concentric_spheres_is_the_gap)
{
  const TriangleMesh inner = sphere(1, 3000), outer = sphere(1.2, 3000);
  EXPECT_NEAR(hausdorff_distance(inner, outer, 20000), 0.2, 2e-3);
  EXPECT_NEAR(hausdorff_distance(outer, inner, 20000), hausdorff_distance(inner, outer, 20000), 1e-12);
  EXPECT_LT(hausdorff_distance(inner, inner, 20000), 1e-12);
}

TEST(Hausdorff, looks_both_ways)
{
  // Vertices of a cube's corners are far from the sphere inside it, while every point of the sphere is near the cube.
  const TriangleMesh box = cube(2, 1000), ball = sphere(1, 3000);
  const double corner_gap = std::sqrt(3.0) - 1;
  EXPECT_NEAR(hausdorff_distance(ball, box, 20000), corner_gap, 2e-3);
  EXPECT_NEAR(hausdorff_distance(box, ball, 20000), corner_gap, 2e-3);
}

class Alignment : public ::testing::Test {
 protected:
  TriangleMesh mesh = bumpsphere(1, 1000);
  RigidMotion motion{Eigen::AngleAxisd(0.1, Vec3(1, 2, 3).normalized()).toRotationMatrix(), Vec3(0.05, -0.03, 0.02)};
};

TEST_F(Alignment, undoes_a_motion_by_correspondence)
{
  const RigidMotion back = rigid_alignment(motion(mesh.vertices), mesh.vertices);
  EXPECT_LT((back(motion(mesh.vertices)) - mesh.vertices).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_NEAR(back.rotation.determinant(), 1, 1e-12);
}

TEST_F(Alignment, has_no_reflection)
{
  Positions mirrored = mesh.vertices;
  mirrored.col(0) *= -1;
  EXPECT_NEAR(rigid_alignment(mirrored, mesh.vertices).rotation.determinant(), 1, 1e-12);
}

TEST_F(Alignment, brings_points_back_onto_a_surface)
{
  const SurfaceDistance surface(mesh);
  const Positions moved = motion(mesh.vertices);
  const Positions aligned = rigid_alignment(moved, surface)(moved);
  EXPECT_GT(surface.distances(moved).maxCoeff(), 0.05);
  EXPECT_LT(surface.distances(aligned).maxCoeff(), 1e-6);
  EXPECT_LT((aligned - mesh.vertices).cwiseAbs().maxCoeff(), 1e-6);
}

TEST_F(Alignment, leaves_a_sphere_that_may_turn_freely_in_place)
{
  const SurfaceDistance surface(sphere(1, 5000));
  const Positions points = sphere(1.1, 300).vertices.rowwise() + Eigen::RowVector3d(0.1, 0, 0);
  const RigidMotion found = rigid_alignment(points, surface);
  EXPECT_LT((found.rotation - Eigen::Matrix3d::Identity()).norm(), 0.1);
  EXPECT_LT(found(points).colwise().mean().norm(), 2e-3);
}

}  // namespace
}  // namespace softform
