#pragma once

#include <optional>
#include <vector>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>

#include "softform/mesh/triangle_mesh.hpp"

/// CGAL's half-edge mesh and the way to it and back. For the sources of softform_geometry only.
namespace softform::cgal {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using SurfaceMesh = CGAL::Surface_mesh<Point>;
using VertexIndex = SurfaceMesh::Vertex_index;
using EdgeIndex = SurfaceMesh::Edge_index;
using FaceIndex = SurfaceMesh::Face_index;

inline Point point(const Positions& positions, Eigen::Index i)
{
  return {positions(i, 0), positions(i, 1), positions(i, 2)};
}

/// Vertices and faces keep their order. Nothing when the triangles are no oriented manifold.
inline std::optional<SurfaceMesh> to_surface_mesh(const TriangleMesh& mesh)
{
  SurfaceMesh result;
  for (int i = 0; i < mesh.vertex_count(); ++i) result.add_vertex(point(mesh.vertices, i));
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    const auto corner = [&](int k) { return VertexIndex(static_cast<SurfaceMesh::size_type>(mesh.triangles(t, k))); };
    if (result.add_face(corner(0), corner(1), corner(2)) == SurfaceMesh::null_face()) return std::nullopt;
  }
  return result;
}

/// Precondition: no garbage in the mesh, all faces triangles.
inline TriangleMesh from_surface_mesh(const SurfaceMesh& mesh)
{
  TriangleMesh result;
  result.vertices.resize(static_cast<Eigen::Index>(mesh.number_of_vertices()), 3);
  result.triangles.resize(static_cast<Eigen::Index>(mesh.number_of_faces()), 3);
  for (const VertexIndex v : mesh.vertices()) {
    const Point& p = mesh.point(v);
    result.vertices.row(static_cast<Eigen::Index>(v.idx())) << p.x(), p.y(), p.z();
  }
  for (const FaceIndex f : mesh.faces()) {
    int k = 0;
    for (const VertexIndex v : mesh.vertices_around_face(mesh.halfedge(f)))
      result.triangles(static_cast<Eigen::Index>(f.idx()), k++) = static_cast<int>(v.idx());
  }
  return result;
}

}  // namespace softform::cgal
