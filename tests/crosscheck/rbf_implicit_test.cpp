// The implicit surface of a scan: its derivative, and how close it is to the signed distance of a known surface.

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "softform/mesh/rbf_implicit.hpp"
#include "support/deformations.hpp"
#include "support/expect_input_error.hpp"
#include "support/finite_differences.hpp"

namespace softform::testing {
namespace {

constexpr double radius = 0.03;  // [m]

// Points of the upper half of a sphere, in a golden-angle spiral, without those for which `hole`.
template <class Hole>
Positions dome(int count, double noise, const Hole& hole)
{
  std::mt19937_64 generator(7);
  std::normal_distribution<double> normal(0, 1);
  Positions points(count, 3);
  int n = 0;
  for (int i = 0; i < count; ++i) {
    const double z = (i + 0.5) / count, ring = std::sqrt(1 - z * z), angle = 2.399963 * i;
    const Vec3 p = radius * Vec3(ring * std::cos(angle), ring * std::sin(angle), z);
    const Vec3 error(normal(generator), normal(generator), normal(generator));
    if (!hole(p)) points.row(n++) = (p + noise * error).transpose();
  }
  return points.topRows(n);
}

constexpr auto no_hole = [](const Vec3&) { return false; };

// The root mean square of s over the dome above z = 0.15 R.
double rms_on_dome(const RbfImplicit& implicit)
{
  double sum = 0;
  const Positions points = dome(500, 0, [](const Vec3& p) { return p.z() < 0.15 * radius; });
  for (const auto& p : points.rowwise()) sum += std::pow(implicit.value(p.transpose()), 2);
  return std::sqrt(sum / double(points.rows()));
}

TEST(RbfImplicit, GradientIsRight)
{
  const RbfImplicit implicit(dome(400, 5e-5, no_hole), Vec3::Zero(), {.centres = 300});
  for (const Vec3& x : {Vec3(0.01, 0.02, 0.02), Vec3(-0.02, 0, 0.01), Vec3(0, 0, 0.04)}) {
    Vec3 gradient;
    implicit.value(x, gradient);
    const Vec direction = wiggle(3, 2);
    EXPECT_SLOPE(check_slope([&](const Vec& y) { return Vec::Constant(1, implicit.value(y)); }, x, direction,
                             Vec::Constant(1, gradient.dot(direction)), 1e-3));
  }
}

TEST(RbfImplicit, IsTheSignedDistanceOfExactPoints)
{
  const RbfImplicit implicit(dome(2000, 0, no_hole), Vec3::Zero(), {.smoothing = 0});
  EXPECT_LT(rms_on_dome(implicit), 1e-3 * radius);
  const Vec3 up = Vec3(1, 2, 3).normalized();
  for (const double distance : {-2e-3, -1e-3, 1e-3, 2e-3})
    EXPECT_NEAR(implicit.value((radius + distance) * up), distance, 2e-5);
  EXPECT_NEAR(implicit.project(0.9 * radius * up).norm(), radius, 2e-5);
}

TEST(RbfImplicit, SmoothsNoise)
{
  const double noise = 5e-5;
  const Positions scan = dome(2000, noise, no_hole);
  const double smooth = rms_on_dome(RbfImplicit(scan, Vec3::Zero()));
  const double interpolated = rms_on_dome(RbfImplicit(scan, Vec3::Zero(), {.smoothing = 0}));
  EXPECT_LT(smooth, 0.85 * interpolated);
  EXPECT_LT(smooth, 0.8 * noise);
  // The smoothing's own bias is small against the noise.
  EXPECT_LT(rms_on_dome(RbfImplicit(dome(2000, 0, no_hole), Vec3::Zero())), 0.2 * noise);
}

TEST(RbfImplicit, FillsHoles)
{
  const auto in_hole = [](const Vec3& p) { return (p - radius * Vec3(0.6, 0, 0.8)).norm() < 0.3 * radius; };
  const RbfImplicit implicit(dome(2000, 5e-5, in_hole), Vec3::Zero());
  EXPECT_LT(std::abs(implicit.value(radius * Vec3(0.6, 0, 0.8))), 2e-4);
}

TEST(RbfImplicit, RefusesScansThatItCannotUse)
{
  test::expect_input_error([] { RbfImplicit(dome(100, 0, no_hole), Vec3::Zero()); }, {"100 points", "266"});
  Positions scan = dome(300, 0, no_hole);
  scan(17, 2) = std::nan("");
  test::expect_input_error([&] { RbfImplicit(scan, Vec3::Zero()); }, {"point 17", "not finite"});
}

}  // namespace
}  // namespace softform::testing
