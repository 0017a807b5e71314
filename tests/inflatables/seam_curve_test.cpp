#include "softform/inflatables/seam_curve.hpp"

#include <cmath>
#include <numbers>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "softform/mesh/shapes.hpp"
#include "support/expect_input_error.hpp"

namespace softform {
namespace {

double length(const Positions& polyline) { return arc_lengths(polyline)[polyline.rows() - 1]; }

DrawnSeam seam(const std::string& name, const std::vector<Vec3>& points, bool is_closed = false)
{
  DrawnSeam drawn{name, 1, is_closed, {}};
  for (const Vec3& p : points) drawn.points.push_back({p, {}, {}});
  return drawn;
}

SeamPlan plan(std::vector<DrawnSeam> seams) { return {"test.json", std::move(seams), {}, {}}; }

const Geodesics& ball()
{
  static const Geodesics geodesics(sphere(1, 4000));
  return geodesics;
}

const Geodesics& box()
{
  static const Geodesics geodesics(cube(2, 1500));
  return geodesics;
}

TEST(Geodesics, AreGreatCirclesOnASphere)
{
  const Vec3 a = Vec3(1, 0.2, -0.3).normalized(), b = Vec3(-0.6, 1, 0.5).normalized();
  const Positions path = ball().path(a, b, 0.02);
  EXPECT_NEAR(length(path), std::acos(a.dot(b)), 2e-3);
  const Vec3 axis = a.cross(b).normalized();
  EXPECT_LT((path * axis).cwiseAbs().maxCoeff(), 5e-3);
}

TEST(Geodesics, AreStraightAcrossAnUnfoldedEdge)
{
  // Across the edge x = 1, z = 1 of the cube: a straight line once the faces are laid flat.
  const Vec3 a(0.2, -0.5, 1), b(1, 0.6, 0.1);
  const Positions path = box().path(a, b, 0.01);
  EXPECT_NEAR(length(path), std::hypot(0.8 + 0.9, 1.1), 0.01);
  const double y = -0.5 + 1.1 * 0.8 / 1.7;  // where that line crosses the edge
  EXPECT_LT((path.rowwise() - Eigen::RowVector3d(1, y, 1)).rowwise().norm().minCoeff(), 0.01);
}

TEST(SeamCurve, IsTheHermiteSplineInAPlane)
{
  const Vec3 p0(-0.7, -0.5, 1), p1(-0.1, 0.4, 1), p2(0.8, 0.1, 1);
  const SeamNetwork network = lay_seams(box(), plan({seam("s", {p0, p1, p2})}), 0.1);
  ASSERT_EQ(network.segments.size(), 1U);
  // The inner tangent is that of the parabola by chord lengths, at the length of each chord.
  const double l0 = (p1 - p0).norm(), l1 = (p2 - p1).norm();
  const Vec3 tangent = (l1 * (p1 - p0) / l0 + l0 * (p2 - p1) / l1).normalized();
  const auto hermite = [](const Vec3& a, const Vec3& b, const Vec3& m0, const Vec3& m1, double t) -> Vec3 {
    return (2 * t * t * t - 3 * t * t + 1) * a + t * (1 - t) * (1 - t) * m0 + t * t * (3 - 2 * t) * b -
           t * t * (1 - t) * m1;
  };
  const Positions& points = network.segments[0].points;
  for (const double t : {0.25, 0.5, 0.75}) {
    const Vec3 first = hermite(p0, p1, p1 - p0, l0 * tangent, t), second = hermite(p1, p2, l1 * tangent, p2 - p1, t);
    EXPECT_LT((points.rowwise() - first.transpose()).rowwise().norm().minCoeff(), 0.02);
    EXPECT_LT((points.rowwise() - second.transpose()).rowwise().norm().minCoeff(), 0.02);
    for (const Vec3& p : {first, second}) {  // close to a chord, not only to a point
      double off = 1;
      for (Eigen::Index i = 0; i + 1 < points.rows(); ++i) {
        const Vec3 a = points.row(i), ab = points.row(i + 1).transpose() - a;
        const double u = std::clamp((p - a).dot(ab) / ab.squaredNorm(), 0.0, 1.0);
        off = std::min(off, (a + u * ab - p).norm());
      }
      EXPECT_LT(off, 1e-3);
    }
  }
}

TEST(SeamCurve, SeamsMeetWhereTheySnap)
{
  SeamPlan drawn = plan({seam("equator", {{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}}, true)});
  drawn.seams.push_back(
      {"meridian", 1, false, {{{}, "equator", 0.0}, {{0, 0, 1}, {}, {}}, {{-1, 0.02, 0}, "equator", {}}}});
  const SeamNetwork network = lay_seams(ball(), drawn, 0.1);
  ASSERT_EQ(network.nodes.rows(), 2);
  ASSERT_EQ(network.segments.size(), 3U);  // two halves of the equator and the meridian
  EXPECT_EQ(network.segments[0].name, "equator 1");
  EXPECT_EQ(network.segments[1].name, "equator 2");
  EXPECT_EQ(network.segments[0].end, network.segments[1].start);
  EXPECT_EQ(network.segments[1].end, network.segments[0].start);
  for (const SeamSegment& segment : network.segments) EXPECT_NEAR(length(segment.points), std::numbers::pi, 0.05);
}

TEST(SeamCurve, AClosedSeamAloneHasOneNode)
{
  const SeamNetwork network =
      lay_seams(ball(), plan({seam("equator", {{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}}, true)}), 0.1);
  ASSERT_EQ(network.segments.size(), 1U);
  EXPECT_EQ(network.segments[0].start, network.segments[0].end);
  EXPECT_NEAR(length(network.segments[0].points), 2 * std::numbers::pi, 0.01);
}

TEST(SeamCurve, WhatDoesNotMeetIsRefused)
{
  const auto refuses = [](std::vector<DrawnSeam> seams, std::vector<std::string> words) {
    words.emplace_back("test.json");
    test::expect_input_error([&] { lay_seams(ball(), plan(std::move(seams)), 0.1); }, words);
  };
  const DrawnSeam across = seam("across", {{1, 0, 0}, {0, 0, 1}});
  refuses({across, seam("b", {Vec3(1, 1, 1).normalized(), Vec3(1, -1, 1).normalized()})},
          {"seam 'b'", "'across'", "without meeting", "\"near\""});
  refuses({across, seam("b", {{0, 1, 0}, Vec3(1, 0.03, 1).normalized()})}, {"seam 'b'", "'across'", "without meeting"});
  refuses({seam("far", {{1, 0, 0}, {0, 0, 1.3}})}, {"seam 'far'", "point 2", "0.3", "off the target", "move it"});
  refuses({seam("short", {{1, 0, 0}, {1, 0.01, 0}, {0, 1, 0}})}, {"seam 'short'", "points 1 and 2", "leave one out"});
  const auto on_ball = [](double x, double y) { return Vec3(x, y, 1).normalized(); };
  refuses({seam("knot", {on_ball(-1, 0), on_ball(1, 0), on_ball(1, 1), on_ball(0, 1), on_ball(0, -1)})},
          {"seam 'knot'", "crosses itself"});
  DrawnSeam off_seam = seam("b", {{0, 1, 0}, {0, 0, 0}});
  off_seam.points[1] = {{0, 0, -1}, "across", {}};
  refuses({across, off_seam}, {"seam 'b'", "point 2", "off seam 'across'"});
}

}  // namespace
}  // namespace softform
