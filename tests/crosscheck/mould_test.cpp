// Solids and moulds against closed forms.

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "softform/balloons/mould.hpp"
#include "softform/mesh/check.hpp"
#include "softform/mesh/ray_caster.hpp"
#include "softform/mesh/shapes.hpp"
#include "softform/mesh/solids.hpp"
#include "support/expect_input_error.hpp"
#include "support/meshes.hpp"

namespace softform::testing {
namespace {

constexpr double pi = std::numbers::pi;
const Eigen::Matrix3d upright = Eigen::Matrix3d::Identity();

void expect_solid(const TriangleMesh& mesh, int genus)
{
  const MeshReport report = check_mesh(mesh);
  EXPECT_TRUE(report.usable()) << (report.problems.empty() ? "" : report.problems[0].message);
  EXPECT_EQ(report.genus.value_or(-1), genus);
}

TEST(Solids, BoxAndCylinderHaveTheirVolumes)
{
  const TriangleMesh brick = box({1, 2, 3}, frame_along({1, 2, 2}), {2, 3, 4});
  expect_solid(brick, 0);
  EXPECT_NEAR(enclosed_volume(brick), 24, 1e-12);
  const TriangleMesh rod = cylinder({1, 0, 2}, {0, 3, 4}, 2, 5, 60);
  expect_solid(rod, 0);
  EXPECT_NEAR(enclosed_volume(rod), 5 * 60 / 2.0 * 4 * std::sin(2 * pi / 60), 1e-11);
}

TEST(Solids, BooleanOperationsAddAndTakeAway)
{
  const TriangleMesh a = box({0, 0, 0}, upright, {2, 2, 2}), b = box({1, 0.3, 0.2}, upright, {2, 1, 1});
  const TriangleMesh both = ExactSolid(a).unite(b).surface(), rest = ExactSolid(a).subtract(b).surface();
  expect_solid(both, 0);
  expect_solid(rest, 0);
  EXPECT_NEAR(enclosed_volume(both), 9, 1e-12);
  EXPECT_NEAR(enclosed_volume(rest), 7, 1e-12);
  const TriangleMesh drilled = ExactSolid(a).subtract(cylinder({0.1, 0.2, -2}, {0, 0, 1}, 0.5, 4, 24)).surface();
  expect_solid(drilled, 1);
  EXPECT_NEAR(enclosed_volume(drilled), 8 - 2 * 12 * 0.25 * std::sin(2 * pi / 24), 1e-12);
  TriangleMesh open = a;
  open.triangles.conservativeResize(11, 3);
  test::expect_input_error([&] { ExactSolid(b).unite(open); }, {"open", "repair"});
}

// Second order in the grid's cell.
TEST(InnerOffset, OfABallIsASmallerBall)
{
  const double R = 1, depth = 0.3;
  const TriangleMesh ball = sphere(R, 4000);
  const double exact = 4 * pi / 3 * std::pow(R - depth, 3);
  std::vector<double> errors;
  for (const double cell : {0.2, 0.1}) {
    const TriangleMesh inner = inner_offset(ball, depth, cell);
    expect_solid(inner, 0);
    for (const auto& p : inner.vertices.rowwise()) EXPECT_NEAR(p.norm(), R - depth, 0.1 * cell);
    errors.push_back(std::abs(enclosed_volume(inner) - exact) / exact);
  }
  EXPECT_LT(errors[1], 0.02);
  EXPECT_LT(errors[1], 0.35 * errors[0]);
  EXPECT_EQ(inner_offset(ball, 1.1 * R, 0.2).triangle_count(), 0);
}

TEST(InnerOffset, FallsIntoPartsWhereTheSolidIsThin)
{
  const TriangleMesh ball = sphere(1, 1000);
  const TriangleMesh dumbbell = ExactSolid(ball)
                                    .unite(cylinder({0, 0, 0.5}, {0, 0, 1}, 0.2, 2, 24))
                                    .unite(test::joined({}, ball, {0, 0, 3}))
                                    .surface();
  const auto parts = parts_of(inner_offset(dumbbell, 0.3, 0.1));
  ASSERT_EQ(parts.size(), 2u);
  for (const TriangleMesh& part : parts) expect_solid(part, 0);
  EXPECT_NEAR(enclosed_volume(parts[0]), enclosed_volume(parts[1]), 0.02 * enclosed_volume(parts[0]));
}

TEST(RayCaster, MeasuresThicknessAndOpenAir)
{
  const RayCaster rays(box({0, 0, 0}, upright, {2, 3, 4}));
  for (int t = 0; t < 12; ++t) {
    const double side = rays.normal(t).cwiseAbs().dot(Vec3(2, 3, 4));
    EXPECT_NEAR(rays.from_triangle(t, -rays.normal(t)).value_or(-1), side, 1e-12);
    EXPECT_FALSE(rays.from_triangle(t, rays.normal(t)).has_value());
  }
}

class BallMould : public ::testing::Test {
 protected:
  static constexpr double R = 0.03, r = 0.006;
  TriangleMesh ball = sphere(R, 3000);
  Nozzle nozzle = place_nozzle(ball, {.diameter = 2 * r});
  MouldOptions options;
};

TEST_F(BallMould, SolidHasTheVolumeOfItsParts)
{
  const Mould mould = make_mould(ball, nozzle, options);
  expect_solid(mould.surface, 4);
  EXPECT_EQ(mould.genus, 4);
  const double under_tube = pi * r * r * R - 2 * pi / 3 * (R * R * R - std::pow(R * R - r * r, 1.5));
  const double holes = 4 * pi / 4 * std::pow(options.screw_diameter, 2) * options.plate.z();
  const double expected =
      enclosed_volume(ball) + pi * r * r * options.tube_length + under_tube + options.plate.prod() - holes;
  EXPECT_NEAR(enclosed_volume(mould.surface), expected, 2e-3 * expected);
}

TEST_F(BallMould, HollowHasItsWall)
{
  options.wall = 2e-3;
  const Mould mould = make_mould(ball, nozzle, options);
  expect_solid(mould.surface, 4);
  EXPECT_EQ(mould.closed_off, 0);
  const MouldInspection found = inspect_mould(mould.surface, ball, pull_directions(nozzle), 1e-3);
  EXPECT_NEAR(found.smallest_thickness, *options.wall, 0.15 * *options.wall);
  EXPECT_LT(found.thin_fraction, 1e-6);
  options.wall.reset();
  const double cavity = enclosed_volume(make_mould(ball, nozzle, options).surface) - enclosed_volume(mould.surface);
  const double hollow_ball = 4 * pi / 3 * std::pow(R - 2e-3, 3), bore = pi * 16e-6 * 25e-3;
  EXPECT_NEAR(cavity, hollow_ball + bore, 0.02 * hollow_ball);
}

TEST_F(BallMould, RubberIsTrappedBelowTheEquator)
{
  const Mould mould = make_mould(ball, nozzle, options);
  const double cap = 2 * pi * R * (R - std::sqrt(R * R - r * r));
  const double expected = (2 * pi * R * R - cap) / (4 * pi * R * R - cap);
  const MouldInspection away = inspect_mould(mould.surface, ball, {-nozzle.axis}, 1e-3);
  EXPECT_NEAR(away.trapped_fraction, expected, 0.03);
  const MouldInspection any = inspect_mould(mould.surface, ball, pull_directions(nozzle), 1e-3);
  EXPECT_LT(any.trapped_fraction, 0.01);
  // The plate between a screw hole and its edge.
  EXPECT_NEAR(any.smallest_thickness, 2e-3, 1e-4);
}

TEST_F(BallMould, RefusesPartsThatDoNotFit)
{
  const auto expect_refused = [&](const MouldOptions& bad, const std::vector<std::string>& texts) {
    test::expect_input_error([&] { make_mould(ball, nozzle, bad); }, texts);
  };
  for (const double bad : {0.0, -0.01, std::nan("")}) {
    expect_refused({.tube_length = bad}, {"tube"});
    expect_refused({.wall = bad}, {"wall"});
    expect_refused({.plate = {0.04, bad, 0.004}}, {"plate"});
    expect_refused({.screw_diameter = bad}, {"screw"});
  }
  expect_refused({.plate = {0.01, 0.04, 0.004}}, {"plate 10 mm wide", "12 mm", "14 mm or more"});
  expect_refused({.plate = {0.02, 0.02, 0.004}}, {"screw holes", "larger plate"});
  expect_refused({.wall = 5.8e-3}, {"5.8 mm", "thinner wall"});
  expect_refused({.screws = 3}, {"3 screw holes"});
  test::expect_input_error([&] { inspect_mould(ball, ball, {}, 1e-3); }, {"direction"});
  test::expect_input_error([&] { inspect_mould(ball, ball, {Vec3::Zero()}, 1e-3); }, {"no length"});
  test::expect_input_error([&] { inspect_mould(ball, ball, {Vec3(0, 0, 1)}, 0); }, {"positive"});
  // A plate that the shape reaches down to: a dent around the nozzle.
  TriangleMesh dented = ball;
  for (const int i : vertices_around(ball, nozzle.centre, 0.02)) dented.vertices(i, 2) += 0.02;
  test::expect_input_error(
      [&] { make_mould(dented, place_nozzle(dented, {.vertex = nozzle.centre}), {.tube_length = 0.01}); },
      {"touch the plate", "tube of"});
}

}  // namespace
}  // namespace softform::testing
