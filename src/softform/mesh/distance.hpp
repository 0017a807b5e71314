#pragma once

#include <memory>
#include <vector>

#include "softform/mesh/triangle_mesh.hpp"

namespace softform {

/// The closest point of a surface.
struct ClosestPoint {
  Vec3 position;        ///< [m]
  int triangle = -1;    ///< the triangle that it lies on
  Vec3 normal;          ///< of that triangle, of length 1
  double distance = 0;  ///< [m]
};

/// Closest points on a triangle surface, by a tree that is built once. Queries may run in parallel.
class SurfaceDistance {
 public:
  /// Precondition: at least one triangle, finite coordinates. The mesh is copied.
  explicit SurfaceDistance(const TriangleMesh& mesh);
  SurfaceDistance(SurfaceDistance&&) noexcept;
  SurfaceDistance& operator=(SurfaceDistance&&) noexcept;
  ~SurfaceDistance();

  ClosestPoint closest(const Vec3& point) const;

  double distance(const Vec3& point) const { return closest(point).distance; }

  /// The closest point of every row (n); on all cores.
  std::vector<ClosestPoint> closest_points(const Positions& points) const;

  /// The distance of every row (n) [m]; on all cores.
  Vec distances(const Positions& points) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

/// Points (count, 3) spread evenly over a surface: stratified by area, barycentric coordinates from the R2
/// low-discrepancy sequence. The same points on every call.
Positions sample_surface(const TriangleMesh& mesh, int count);

/// How far a surface is from another one, one way [m].
struct ShapeDistance {
  double mean = 0, max = 0;
};

/// Of points all over a surface, sample_surface(), to the closest ones of the target. Vertices alone may well lie on
/// the target while the triangles between them do not.
ShapeDistance sampled_distance(const TriangleMesh& surface, const SurfaceDistance& target, int samples = 100'000);

/// Hausdorff distance of two surfaces [m], both ways, on the vertices and `samples` further points of each. A lower
/// bound that misses at most the largest gap between the samples.
double hausdorff_distance(const TriangleMesh& a, const TriangleMesh& b, int samples = 100'000);

}  // namespace softform
