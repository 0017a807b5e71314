#include "softform/mesh/relax.hpp"

#include <algorithm>
#include <cmath>

#include <CGAL/Polygon_mesh_processing/tangential_relaxation.h>
#include <CGAL/boost/graph/Euler_operations.h>
#include <Eigen/Geometry>

#include "softform/mesh/cgal_mesh_internal.hpp"

namespace softform {
namespace {

namespace PMP = CGAL::Polygon_mesh_processing;
using cgal::SurfaceMesh;
using Halfedge = SurfaceMesh::Halfedge_index;
using EdgeFlags = SurfaceMesh::Property_map<cgal::EdgeIndex, bool>;

Vec3 position(const SurfaceMesh& mesh, cgal::VertexIndex v)
{
  const cgal::Point& p = mesh.point(v);
  return {p.x(), p.y(), p.z()};
}

double angle(const Vec3& apex, const Vec3& a, const Vec3& b)
{
  return std::atan2((a - apex).cross(b - apex).norm(), (a - apex).dot(b - apex));
}

/// Flips the edge a-b, with c and d opposite, when the angles there add up to more than half a turn and the new
/// triangles face the way the old ones do.
void flip_where_not_delaunay(SurfaceMesh& mesh, cgal::EdgeIndex edge)
{
  const Halfedge h = mesh.halfedge(edge), o = mesh.opposite(h);
  const auto tip = mesh.target(mesh.next(h)), other_tip = mesh.target(mesh.next(o));
  const Vec3 a = position(mesh, mesh.source(h)), b = position(mesh, mesh.target(h)), c = position(mesh, tip),
             d = position(mesh, other_tip);
  if (angle(c, a, b) + angle(d, a, b) <= M_PI + 1e-6) return;
  if (mesh.halfedge(tip, other_tip) != SurfaceMesh::null_halfedge()) return;
  const Vec3 old_normal = (b - a).cross(c - a) + (d - a).cross(b - a);
  if ((d - a).cross(c - a).dot(old_normal) <= 0 || (c - b).cross(d - b).dot(old_normal) <= 0) return;
  CGAL::Euler::flip_edge(h, mesh);
}

}  // namespace

TriangleMesh relaxed(const TriangleMesh& mesh, const std::vector<std::pair<int, int>>& fixed_edges,
                     const std::function<Vec3(const Vec3&)>& projection, int rounds)
{
  SurfaceMesh surface = *cgal::to_surface_mesh(mesh);
  const EdgeFlags is_fixed = surface.add_property_map<cgal::EdgeIndex, bool>("e:is_fixed", false).first;
  std::vector<bool> is_held(static_cast<std::size_t>(mesh.vertex_count()), false);
  const auto index = [](int v) { return cgal::VertexIndex(static_cast<SurfaceMesh::size_type>(v)); };
  for (const auto& [start, end] : fixed_edges) {
    is_fixed[surface.edge(surface.halfedge(index(start), index(end)))] = true;
    is_held[static_cast<std::size_t>(start)] = is_held[static_cast<std::size_t>(end)] = true;
  }
  for (int round = 0; round < rounds; ++round) {
    for (const cgal::EdgeIndex edge : surface.edges())
      if (!is_fixed[edge]) flip_where_not_delaunay(surface, edge);
    PMP::tangential_relaxation(surface.vertices(), surface, CGAL::parameters::edge_is_constrained_map(is_fixed));
    for (const cgal::VertexIndex v : surface.vertices()) {
      if (is_held[v.idx()]) continue;
      const Vec3 p = projection(position(surface, v));
      surface.point(v) = cgal::Point(p.x(), p.y(), p.z());
    }
  }
  return cgal::from_surface_mesh(surface);
}

Vec triangle_quality(ConstVec x, const Triangles& triangles)
{
  Vec quality(triangles.rows());
  for (int t = 0; t < triangles.rows(); ++t) {
    const Vec3 a = vertex(x, triangles(t, 0)), b = vertex(x, triangles(t, 1)), c = vertex(x, triangles(t, 2));
    const double area = 0.5 * (b - a).cross(c - a).norm();
    const double sum = (b - a).squaredNorm() + (c - b).squaredNorm() + (a - c).squaredNorm();
    quality[t] = sum == 0 ? 0 : 4 * std::sqrt(3.0) * area / sum;
  }
  return quality;
}

double smallest_quality(ConstVec x, const Triangles& triangles)
{
  return triangle_quality(x, triangles).minCoeff<Eigen::PropagateNaN>();
}

}  // namespace softform
