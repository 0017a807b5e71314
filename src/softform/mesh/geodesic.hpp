#pragma once

#include <vector>

#include "softform/mesh/distance.hpp"
#include "softform/mesh/triangle_mesh.hpp"

namespace softform {

/// Nearly shortest paths on a surface: along mesh edges first, then pulled tight on the surface. They agree with exact
/// geodesics up to the spacing of their points, whose chords cut across edges and bends. Precondition: the surface is
/// connected.
class Geodesics {
 public:
  explicit Geodesics(const TriangleMesh& mesh);

  /// Points (n, 3) on the surface from the one closest to `start` to the one closest to `end`, at most `spacing` apart.
  Positions path(const Vec3& start, const Vec3& end, double spacing) const;

  const SurfaceDistance& surface() const { return surface_; }

 private:
  Positions edge_path(const ClosestPoint& start, const ClosestPoint& end) const;
  void pull_tight(Positions& path) const;

  TriangleMesh mesh_;
  std::vector<std::vector<int>> neighbours_;
  SurfaceDistance surface_;
};

/// Arc lengths of a polyline's points from its first (n).
Vec arc_lengths(const Positions& polyline);

/// The point of a polyline at an arc length, clamped to its ends.
Vec3 point_at(const Positions& polyline, const Vec& arcs, double arc);

/// `count` points at equal arc lengths, ends included.
Positions resampled(const Positions& polyline, int count);

}  // namespace softform
