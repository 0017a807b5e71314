// The nozzle (thesis 4.4.2): where it lies, the rest mesh around it, and a balloon that is held by it.

#include <cmath>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "softform/balloons/balloon_design.hpp"
#include "softform/balloons/nozzle_smoothing.hpp"
#include "softform/mesh/self_intersections.hpp"
#include "softform/mesh/shapes.hpp"
#include "support/deformations.hpp"
#include "support/expect_input_error.hpp"
#include "support/finite_differences.hpp"
#include "support/test_balloon.hpp"

namespace softform::testing {
namespace {

constexpr double radius = 0.05;  // [m]
constexpr double diameter_of_nozzle = 0.024;

TriangleMesh ellipsoid(int vertex_count)
{
  TriangleMesh mesh = irregular_sphere(radius, vertex_count);
  mesh.vertices.col(0) *= 1.4;
  mesh.vertices.col(1) *= 0.9;
  return mesh;
}

Nozzle bottom_of(const TriangleMesh& mesh) { return place_nozzle(mesh, {.diameter = diameter_of_nozzle}); }

TEST(NozzlePlacement, IsADiscAtTheBottom)
{
  const TriangleMesh mesh = irregular_sphere(radius, 600);
  const Nozzle nozzle = bottom_of(mesh);
  EXPECT_LT(nozzle.position.z(), -0.99 * radius);
  EXPECT_LT(nozzle.axis.z(), -0.98);
  EXPECT_NEAR(nozzle.axis.norm(), 1, 1e-12);
  int inside = 0;
  for (const auto& p : mesh.vertices.rowwise()) inside += (p.transpose() - nozzle.position).norm() <= nozzle.radius;
  EXPECT_EQ(static_cast<int>(nozzle.vertices.size()), inside);
  // By direction and by vertex.
  const Nozzle side = place_nozzle(mesh, {.direction = {0, 5, 0}, .diameter = diameter_of_nozzle});
  EXPECT_GT(side.position.y(), 0.99 * radius);
  EXPECT_EQ(place_nozzle(mesh, {.vertex = side.centre, .diameter = diameter_of_nozzle}).vertices, side.vertices);
}

TEST(NozzlePlacement, RefusesWhatIsNoNozzle)
{
  const TriangleMesh mesh = irregular_sphere(radius, 600);
  const auto expect_refused = [&](const NozzlePlacement& placement, const std::vector<std::string>& texts) {
    test::expect_input_error([&] { place_nozzle(mesh, placement); }, texts);
  };
  for (const double bad : {0.0, -0.01, std::nan(""), HUGE_VAL}) expect_refused({.diameter = bad}, {"diameter"});
  expect_refused({.direction = Vec3::Zero()}, {"direction", "0,0,-1"});
  expect_refused({.direction = {0, std::nan(""), 1}}, {"direction"});
  expect_refused({.vertex = -1}, {"vertex is -1", "0 to 599"});
  expect_refused({.vertex = 600}, {"vertex is 600", "0 to 599"});
  expect_refused({.diameter = 0.001}, {"finer than the mesh", "at least"});
  expect_refused({.diameter = 5 * radius}, {"no disc", "smaller"});
}

TEST(NozzleSmoothing, DerivativeIsRight)
{
  const TriangleMesh mesh = ellipsoid(200);
  const auto surface = RbfImplicit::from_normals(mesh.vertices, vertex_normals(flatten(mesh.vertices), mesh.triangles));
  const NozzleSmoothing program(mesh, vertices_around(mesh, 7, radius), surface, 100);
  const int n = program.variable_count();
  ASSERT_GT(n, 30);
  ASSERT_LT(n, 3 * mesh.vertex_count());
  const Vec z = program.initial_point() + 0.1 * wiggle(n, 3), direction = wiggle(n, 5);
  SparseMatrix R;
  program.residual_jacobian(z, R);
  const auto residuals = [&](const Vec& y) {
    Vec r;
    program.residuals(y, r);
    return r;
  };
  EXPECT_SLOPE(check_slope(residuals, z, direction, R * direction, 1e-2));
}

TEST(NozzleSmoothing, LeavesAMeshOfTheScaledSurface)
{
  constexpr double scale = 0.5;
  const TriangleMesh target = irregular_sphere(radius, 1200);
  const Nozzle nozzle = bottom_of(target);
  const TriangleMesh rest = rest_shape_with_nozzle(target, nozzle, scale);
  EXPECT_EQ(count_self_intersections(rest), 0);
  const Vec3 centre = (1 - scale) * nozzle.position;
  const double edge = mean_edge_length(rest);
  const FixedDofs held = held_by(nozzle, target.vertex_count());
  for (int i = 0; i < rest.vertex_count(); ++i) {
    if (held.free[3 * i] == 0) {
      EXPECT_EQ(rest.vertices.row(i), target.vertices.row(i));
    } else {
      EXPECT_NEAR((rest.vertices.row(i).transpose() - centre).norm(), scale * radius, 0.01 * edge);
    }
  }
  double smallest = HUGE_VAL;  // cosine between triangles and the sphere
  for (const auto& t : rest.triangles.rowwise()) {
    const Vec3 a = rest.vertices.row(t[0]), b = rest.vertices.row(t[1]), c = rest.vertices.row(t[2]);
    smallest = std::min(smallest, (b - a).cross(c - a).normalized().dot(((a + b + c) / 3 - centre).normalized()));
  }
  EXPECT_GT(smallest, 0.8);
}

TEST(NozzleSmoothing, RefusesANozzleThatDoesNotFit)
{
  const TriangleMesh target = irregular_sphere(radius, 600);
  test::expect_input_error([&] { rest_shape_with_nozzle(target, bottom_of(target), 0.12); },
                           {"24 mm", "scaled by 0.12", "smaller nozzle"});
}

class HeldBalloon : public ::testing::Test {
 protected:
  HeldBalloon() : target(ellipsoid(600))
  {
    BalloonOptions options;
    options.nozzle = NozzlePlacement{.diameter = diameter_of_nozzle};
    design = design_balloon(target, silicone(), options);
  }
  TriangleMesh target;
  BalloonDesign design;
};

TEST_F(HeldBalloon, IsSoundAndHeld)
{
  EXPECT_EQ(design.negative_eigenvalues, 0);
  EXPECT_LT(design.residual, 1e-6);
  EXPECT_EQ(count_self_intersections(design.rest), 0);
  EXPECT_GT(design.pressure, 0);
  EXPECT_NEAR(enclosed_volume(design.inflated), enclosed_volume(target), 1e-7 * enclosed_volume(target));
  ASSERT_TRUE(design.nozzle.has_value());
  EXPECT_GT(design.nozzle->vertices.size(), 6u);
  for (const int i : design.nozzle->vertices) {
    EXPECT_EQ(design.rest.vertices.row(i), target.vertices.row(i));
    EXPECT_EQ(design.inflated.vertices.row(i), target.vertices.row(i));
  }
  const auto distance = [&](const TriangleMesh& mesh) {
    return shape_distance(aligned_to(target, flatten(mesh.vertices)), target).mean;
  };
  EXPECT_LT(2 * distance(design.inflated), distance(design.downscaled));
}

// A closed balloon needs no force from outside: what the nozzle bears is in balance.
TEST_F(HeldBalloon, NozzleForcesAreInBalance)
{
  const TestBalloon balloon(design.rest, silicone());
  const PressurePotential potential(balloon.balloon, design.pressure, flatten(design.inflated.vertices));
  Vec g;
  potential.gradient(flatten(design.inflated.vertices), g);
  Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
  double largest = 0;
  for (const int i : design.nozzle->vertices) {
    const Vec3 reaction = g.segment<3>(3 * i), arm = target.vertices.row(i).transpose() - design.nozzle->position;
    force += reaction;
    torque += arm.cross(reaction);
    largest = std::max(largest, reaction.norm());
  }
  EXPECT_GT(largest, 0.1 * potential.force_scale());
  EXPECT_LT(force.norm(), 1e-5 * largest);
  EXPECT_LT(torque.norm(), 1e-5 * largest * design.nozzle->radius);
}

}  // namespace
}  // namespace softform::testing
