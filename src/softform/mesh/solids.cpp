#include "softform/mesh/solids.hpp"

#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <CGAL/Surface_mesh.h>
#include <Eigen/Geometry>

#include "softform/core/error.hpp"

namespace softform {
namespace {

namespace PMP = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using ExactMesh = CGAL::Surface_mesh<Kernel::Point_3>;

ExactMesh exact_mesh(const TriangleMesh& surface)
{
  ExactMesh mesh;
  for (const auto& p : surface.vertices.rowwise()) mesh.add_vertex({p.x(), p.y(), p.z()});
  bool is_manifold = true;
  for (const auto& t : surface.triangles.rowwise()) {
    const auto corner = [&](int k) { return ExactMesh::Vertex_index(static_cast<ExactMesh::size_type>(t[k])); };
    is_manifold = is_manifold && mesh.add_face(corner(0), corner(1), corner(2)) != ExactMesh::null_face();
  }
  if (!is_manifold || !CGAL::is_closed(mesh)) throw InputError("a solid's surface is open or no manifold: repair it");
  return mesh;
}

void require(bool is_solid)
{
  if (!is_solid)
    throw InputError("two solids meet in an edge or a point, so that none comes of them: move or resize one of them");
}

}  // namespace

struct ExactSolid::Mesh {
  ExactMesh exact;
};

ExactSolid::ExactSolid(const TriangleMesh& surface) : mesh_(std::make_unique<Mesh>(Mesh{exact_mesh(surface)})) {}
ExactSolid::ExactSolid(ExactSolid&&) noexcept = default;
ExactSolid& ExactSolid::operator=(ExactSolid&&) noexcept = default;
ExactSolid::~ExactSolid() = default;

ExactSolid& ExactSolid::unite(const TriangleMesh& other)
{
  ExactMesh with = exact_mesh(other);
  require(PMP::corefine_and_compute_union(mesh_->exact, with, mesh_->exact));
  mesh_->exact.collect_garbage();
  return *this;
}

ExactSolid& ExactSolid::subtract(const TriangleMesh& other)
{
  ExactMesh with = exact_mesh(other);
  require(PMP::corefine_and_compute_difference(mesh_->exact, with, mesh_->exact));
  mesh_->exact.collect_garbage();
  return *this;
}

TriangleMesh ExactSolid::surface() const
{
  const ExactMesh& exact = mesh_->exact;
  TriangleMesh rounded{Positions(Eigen::Index(exact.number_of_vertices()), 3),
                       Triangles(Eigen::Index(exact.number_of_faces()), 3)};
  for (const auto v : exact.vertices()) {
    const auto& p = exact.point(v);
    rounded.vertices.row(Eigen::Index(v.idx())) << CGAL::to_double(p.x()), CGAL::to_double(p.y()),
        CGAL::to_double(p.z());
  }
  for (const auto f : exact.faces()) {
    int k = 0;
    for (const auto v : exact.vertices_around_face(exact.halfedge(f)))
      rounded.triangles(Eigen::Index(f.idx()), k++) = static_cast<int>(v.idx());
  }
  return rounded;
}

Eigen::Matrix3d frame_along(const Vec3& axis)
{
  Eigen::Matrix3d frame;
  frame.col(2) = axis.normalized();
  frame.col(0) = frame.col(2).unitOrthogonal();
  frame.col(1) = frame.col(2).cross(frame.col(0));
  return frame;
}

TriangleMesh cylinder(const Vec3& base, const Vec3& axis, double radius, double length, int segments)
{
  const Eigen::Matrix3d frame = frame_along(axis);
  const int n = segments;
  TriangleMesh mesh{Positions(2 * n + 2, 3), Triangles(4 * n, 3)};
  for (int i = 0; i < n; ++i) {
    const double angle = 2 * std::numbers::pi * i / n;
    const Vec3 rim = base + frame * Vec3(radius * std::cos(angle), radius * std::sin(angle), 0);
    mesh.vertices.row(i) = rim;
    mesh.vertices.row(n + i) = rim + length * frame.col(2);
    const int next = (i + 1) % n;
    mesh.triangles.row(4 * i) << i, next, n + next;
    mesh.triangles.row(4 * i + 1) << i, n + next, n + i;
    mesh.triangles.row(4 * i + 2) << 2 * n, next, i;
    mesh.triangles.row(4 * i + 3) << 2 * n + 1, n + i, n + next;
  }
  mesh.vertices.row(2 * n) = base;
  mesh.vertices.row(2 * n + 1) = base + length * frame.col(2);
  return mesh;
}

TriangleMesh box(const Vec3& centre, const Eigen::Matrix3d& axes, const Vec3& sizes)
{
  TriangleMesh mesh{Positions(8, 3), Triangles(12, 3)};
  for (int i = 0; i < 8; ++i) {
    const Vec3 corner((i & 1) != 0 ? 0.5 : -0.5, (i & 2) != 0 ? 0.5 : -0.5, (i & 4) != 0 ? 0.5 : -0.5);
    mesh.vertices.row(i) = centre + axes * corner.cwiseProduct(sizes);
  }
  mesh.triangles << 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7,
      1, 7, 5;
  return mesh;
}

std::vector<TriangleMesh> parts_of(const TriangleMesh& mesh)
{
  const auto neighbours = vertex_neighbours(mesh.triangles, mesh.vertex_count());
  std::vector<int> part_of(neighbours.size(), -1), new_index(neighbours.size(), 0);
  std::vector<std::vector<int>> vertices, triangles;
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    const int seed = mesh.triangles(t, 0);
    if (part_of[std::size_t(seed)] < 0) {
      const int part = static_cast<int>(vertices.size());
      auto& members = vertices.emplace_back(std::vector<int>{seed});
      triangles.emplace_back();
      part_of[std::size_t(seed)] = part;
      for (std::size_t k = 0; k < members.size(); ++k) {
        new_index[std::size_t(members[k])] = static_cast<int>(k);
        for (const int j : neighbours[std::size_t(members[k])])
          if (part_of[std::size_t(j)] < 0) {
            part_of[std::size_t(j)] = part;
            members.push_back(j);
          }
      }
    }
    triangles[std::size_t(part_of[std::size_t(seed)])].push_back(t);
  }
  std::vector<TriangleMesh> parts;
  for (std::size_t k = 0; k < vertices.size(); ++k) {
    const Triangles old = mesh.triangles(triangles[k], Eigen::all);
    parts.push_back(
        {mesh.vertices(vertices[k], Eigen::all), old.unaryExpr([&](int i) { return new_index[std::size_t(i)]; })});
  }
  return parts;
}

}  // namespace softform
