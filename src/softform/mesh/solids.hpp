#pragma once

#include <memory>
#include <vector>

#include "softform/mesh/triangle_mesh.hpp"

namespace softform {

/// Parts to build solids from: closed, outward-oriented surfaces.

/// A cylinder from `base` along `axis` (any length), with a polygon of `segments` corners on its circles. It encloses
/// the volume of the polygon. Precondition: radius, length > 0, segments >= 3.
TriangleMesh cylinder(const Vec3& base, const Vec3& axis, double radius, double length, int segments = 96);

/// A box of the given side lengths along the columns of `axes` (a rotation).
TriangleMesh box(const Vec3& centre, const Eigen::Matrix3d& axes, const Vec3& sizes);

/// A rotation whose third column is `axis` (any length).
Eigen::Matrix3d frame_along(const Vec3& axis);

/// A solid that others are added to and taken from (CGAL's corefinement). Its points stay exact from one operation to
/// the next: rounded ones would make faces that ought to be flat cut each other, on which the next operation fails.
class ExactSolid {
 public:
  /// Throws InputError unless the surface is a closed manifold. Precondition: it does not cut itself, faces outwards.
  explicit ExactSolid(const TriangleMesh& surface);
  ExactSolid(ExactSolid&&) noexcept;
  ExactSolid& operator=(ExactSolid&&) noexcept;
  ~ExactSolid();

  /// Throw InputError when no solid comes of it: when the two meet in an edge or a point.
  ExactSolid& unite(const TriangleMesh& other);
  ExactSolid& subtract(const TriangleMesh& other);

  /// Its surface, rounded.
  TriangleMesh surface() const;

 private:
  struct Mesh;
  std::unique_ptr<Mesh> mesh_;
};

/// The surface of the points of a solid that lie deeper than `depth`, from a grid of `cell` (marching tetrahedra on its
/// distance field): what remains when a wall of that thickness is left. Empty where no point is that deep. Parts that
/// do not hang together are returned together: see parts_of(). Lengths in the mesh's unit.
TriangleMesh inner_offset(const TriangleMesh& solid, double depth, double cell);

/// The connected parts of a surface, each with the vertices that it uses, in the order of their first triangle.
std::vector<TriangleMesh> parts_of(const TriangleMesh& mesh);

}  // namespace softform
