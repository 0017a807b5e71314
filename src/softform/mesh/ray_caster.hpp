#pragma once

#include <memory>
#include <optional>

#include "softform/mesh/triangle_mesh.hpp"

namespace softform {

/// Where rays meet a triangle surface, by a tree that is built once. Queries may run in parallel.
class RayCaster {
 public:
  /// Precondition: at least one triangle, finite coordinates. The mesh is copied.
  explicit RayCaster(const TriangleMesh& mesh);
  RayCaster(RayCaster&&) noexcept;
  RayCaster& operator=(RayCaster&&) noexcept;
  ~RayCaster();

  /// How far a ray from the middle of triangle t goes along a direction of length 1 until it meets another triangle, in
  /// the mesh's unit; nothing when it meets none.
  std::optional<double> from_triangle(int t, const Vec3& direction) const;

  /// Middle and unit normal of a triangle.
  Vec3 middle(int t) const;
  Vec3 normal(int t) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace softform
