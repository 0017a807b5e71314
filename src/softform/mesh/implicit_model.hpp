#pragma once

#include <variant>
#include <vector>

#include "softform/mesh/triangle_mesh.hpp"

namespace softform {

/// A function of space and its gradient: negative inside, positive outside. Near the surface about the distance [m].
struct ImplicitValue {
  double value = 0;
  Vec3 gradient = Vec3::Zero();
};

/// A ball, and for RoundTube one of the balls that it is the envelope of.
struct Ball {
  Vec3 center;
  double radius;  ///< [m]
};

/// The envelope of balls that move along a smooth curve through the given ones (Catmull-Rom) while their radius
/// changes: one ball, a round cone, a limb, a tail. Exact distance, up to the pieces of the curve.
struct RoundTube {
  /// Precondition: at least one ball, centres that follow each other differ.
  explicit RoundTube(const std::vector<Ball>& balls);
  std::vector<Ball> balls;  ///< with the curve's between the given ones; round cones connect them
};

/// Semi-axes `radii` along the columns of `axes` (a rotation). The value is a distance to first order in it.
struct Ellipsoid {
  Vec3 center, radii;
  Eigen::Matrix3d axes;
};

/// Half-sizes include the rounding. Exact distance.
struct RoundedBox {
  Vec3 center, half_sizes;
  double rounding;
  Eigen::Matrix3d axes;
};

/// Exact distance.
struct Torus {
  Vec3 center, axis;  ///< |axis| = 1
  double ring_radius, tube_radius;
};

using Primitive = std::variant<RoundTube, Ellipsoid, RoundedBox, Torus>;

/// The signed distance of a primitive, or what stands for it.
ImplicitValue evaluate(const Primitive& primitive, const Vec3& point);

/// min(a, b) rounded where |a - b| < blend: min - (blend - |a - b|)^2 / (4 blend). Once continuously differentiable,
/// at most blend / 4 below the minimum.
ImplicitValue smooth_union(const ImplicitValue& a, const ImplicitValue& b, double blend);

/// A solid built of parts, in their order.
struct ImplicitModel {
  struct Part {
    Primitive primitive;
    double blend = 0;          ///< over which it melts into the parts before it [m]
    bool is_mirrored = false;  ///< its reflection at the plane x = 0 belongs to it
    bool is_removed = false;   ///< taken away from the parts before it
  };
  std::vector<Part> parts;

  ImplicitValue evaluate(const Vec3& point) const;

  /// A ball that the solid lies in and whose centre lies inside the solid.
  /// Throws InputError when no part has its centre inside.
  Ball bounding_ball() const;
};

/// The point of the surface that Newton's method along the gradient reaches from `point`, which should be close to it.
Vec3 projected(const ImplicitModel& model, Vec3 point);

/// The surface with exactly `vertex_count` vertices: watertight, of genus 0, free of self-intersections, nearly
/// equilateral triangles, every vertex on the surface. Deterministic. Parts that do not touch the one around
/// bounding_ball()'s centre are left out. Throws InputError when the solid has another genus or the count is too small
/// for it.
TriangleMesh mesh_model(const ImplicitModel& model, int vertex_count);

}  // namespace softform
