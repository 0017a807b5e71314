#pragma once

#include <initializer_list>

#include "softform/mesh/triangle_mesh.hpp"

namespace softform::test {

inline TriangleMesh make_mesh(std::initializer_list<Vec3> vertices, std::initializer_list<Eigen::RowVector3i> triangles)
{
  TriangleMesh mesh;
  mesh.vertices.resize(static_cast<Eigen::Index>(vertices.size()), 3);
  mesh.triangles.resize(static_cast<Eigen::Index>(triangles.size()), 3);
  Eigen::Index i = 0, t = 0;
  for (const Vec3& vertex : vertices) mesh.vertices.row(i++) = vertex.transpose();
  for (const auto& triangle : triangles) mesh.triangles.row(t++) = triangle;
  return mesh;
}

/// The corner tetrahedron of the unit cube, volume 1/6.
inline TriangleMesh tetrahedron()
{
  return make_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}});
}

/// Both meshes in one, the second moved.
inline TriangleMesh joined(const TriangleMesh& a, const TriangleMesh& b, const Vec3& offset)
{
  TriangleMesh mesh;
  mesh.vertices.resize(a.vertices.rows() + b.vertices.rows(), 3);
  mesh.vertices << a.vertices, b.vertices.rowwise() + offset.transpose();
  mesh.triangles.resize(a.triangles.rows() + b.triangles.rows(), 3);
  mesh.triangles << a.triangles, (b.triangles.array() + a.vertex_count()).matrix();
  return mesh;
}

}  // namespace softform::test
