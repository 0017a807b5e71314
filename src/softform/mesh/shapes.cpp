#include "softform/mesh/shapes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <vector>

#include <CGAL/convex_hull_3.h>
#include <Eigen/Geometry>
#include <fmt/format.h>

#include "softform/core/error.hpp"
#include "softform/mesh/cgal_mesh_internal.hpp"
#include "softform/mesh/remesh.hpp"

namespace softform {
namespace {

void require_vertices(const char* shape, int vertex_count, int least)
{
  if (vertex_count < least)
    throw InputError(fmt::format("a {} of {} vertices is too coarse; ask for at least {}", shape, vertex_count, least));
}

/// Corners of an icosahedron, of length 1.
std::array<Vec3, 12> icosahedron_corners()
{
  std::array<Vec3, 12> corners;
  std::size_t i = 0;
  for (const double a : {-1.0, 1.0}) {
    for (const double b : {-std::numbers::phi, std::numbers::phi}) {
      corners[i++] = Vec3(0, a, b).normalized();
      corners[i++] = Vec3(a, b, 0).normalized();
      corners[i++] = Vec3(b, 0, a).normalized();
    }
  }
  return corners;
}

/// The closest point of a cube's surface to a point near it; within round-off of an edge, a point of the edge.
Vec3 onto_cube(Vec3 p, double half_edge)
{
  Eigen::Index nearest;
  p.cwiseAbs().maxCoeff(&nearest);
  for (Eigen::Index k = 0; k < 3; ++k)
    if (k == nearest || std::abs(p[k]) > half_edge * (1 - 1e-9)) p[k] = std::copysign(half_edge, p[k]);
  return p;
}

/// Triangles around points that all lie on their convex hull. CGAL's hull comes in an order that differs from run to
/// run: the points keep theirs here, and the triangles are sorted.
TriangleMesh convex_hull(const Positions& points)
{
  std::vector<cgal::Point> list;
  std::map<cgal::Point, int> index_of;
  for (int i = 0; i < points.rows(); ++i) index_of[list.emplace_back(cgal::point(points, i))] = i;
  cgal::SurfaceMesh hull;
  CGAL::convex_hull_3(list.begin(), list.end(), hull);

  std::vector<std::array<int, 3>> triangles;
  for (const cgal::FaceIndex f : hull.faces()) {
    std::array<int, 3> corners{};
    std::size_t k = 0;
    for (const cgal::VertexIndex v : hull.vertices_around_face(hull.halfedge(f)))
      corners[k++] = index_of.at(hull.point(v));
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    triangles.push_back(corners);
  }
  std::sort(triangles.begin(), triangles.end());
  TriangleMesh mesh{points, Triangles(static_cast<Eigen::Index>(triangles.size()), 3)};
  for (Eigen::Index t = 0; t < mesh.triangles.rows(); ++t)
    mesh.triangles.row(t) = Eigen::RowVector3i::Map(triangles[static_cast<std::size_t>(t)].data());
  return mesh;
}

/// A cube of cells x cells squares a face, two triangles a square.
TriangleMesh grid_cube(double edge_length, int cells)
{
  std::map<std::array<int, 3>, int> index_of;
  std::vector<Eigen::RowVector3i> triangles;
  const auto index = [&](const std::array<int, 3>& p) {
    return index_of.try_emplace(p, static_cast<int>(index_of.size())).first->second;
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const int level : {0, cells}) {
      for (int i = 0; i < cells; ++i) {
        for (int j = 0; j < cells; ++j) {
          const auto corner = [&](int u, int v) {
            std::array<int, 3> p{};
            p[axis] = level;
            p[(axis + 1) % 3] = level == 0 ? v : u;  // swapped on the lower face, so that both face outwards
            p[(axis + 2) % 3] = level == 0 ? u : v;
            return index(p);
          };
          triangles.emplace_back(corner(i, j), corner(i + 1, j), corner(i + 1, j + 1));
          triangles.emplace_back(corner(i, j), corner(i + 1, j + 1), corner(i, j + 1));
        }
      }
    }
  }
  TriangleMesh mesh;
  mesh.vertices.resize(static_cast<Eigen::Index>(index_of.size()), 3);
  for (const auto& [p, i] : index_of)
    mesh.vertices.row(i) =
        edge_length * (Eigen::RowVector3d(p[0], p[1], p[2]) / cells - Eigen::RowVector3d::Constant(0.5));
  mesh.triangles.resize(static_cast<Eigen::Index>(triangles.size()), 3);
  for (std::size_t t = 0; t < triangles.size(); ++t) mesh.triangles.row(static_cast<Eigen::Index>(t)) = triangles[t];
  return mesh;
}

}  // namespace

TriangleMesh sphere(double radius, int vertex_count)
{
  require_vertices("sphere", vertex_count, 12);
  const double golden_angle = std::numbers::pi * (3 - std::sqrt(5.0));
  Positions points(vertex_count, 3);
  for (int i = 0; i < vertex_count; ++i) {
    const double z = 1 - (2 * i + 1.0) / vertex_count;
    const double ring = std::sqrt(1 - z * z);
    points.row(i) << ring * std::cos(golden_angle * i), ring * std::sin(golden_angle * i), z;
  }
  return convex_hull(radius * points);
}

TriangleMesh irregular_sphere(double radius, int vertex_count)
{
  require_vertices("sphere of irregular mesh", vertex_count, 100);
  RemeshOptions options;
  options.projection = [radius](const Vec3& p) -> Vec3 { return radius * p.normalized(); };
  return remesh_to_vertex_count(sphere(radius, 2 * vertex_count), vertex_count, options);
}

TriangleMesh cube(double edge_length, int vertex_count)
{
  require_vertices("cube", vertex_count, 200);
  // Equilateral triangles: 2 V of them, of sqrt(3)/4 l^2 each, cover 6 a^2. The grid fixes the vertices on the edges.
  const int cells = static_cast<int>(std::lround(std::sqrt(vertex_count / (4 * std::sqrt(3.0)))));
  RemeshOptions options;
  options.feature_angle = 60;
  options.projection = [half = edge_length / 2](const Vec3& p) { return onto_cube(p, half); };
  return remesh_to_vertex_count(grid_cube(edge_length, cells), vertex_count, options);
}

double bumpsphere_radius(const Vec3& direction)
{
  constexpr double height = 0.15;
  constexpr double half_angle = 0.45;
  static const auto corners = icosahedron_corners();
  const Vec3 u = direction.normalized();
  double radius = 1;
  for (const Vec3& corner : corners) {
    const double s = std::acos(std::clamp(u.dot(corner), -1.0, 1.0)) / half_angle;
    if (s < 1) radius += height * (1 - s * s) * (1 - s * s);
  }
  return radius;
}

TriangleMesh bumpsphere(double radius, int vertex_count)
{
  require_vertices("bumpsphere", vertex_count, 1000);
  RemeshOptions options;
  options.projection = [radius](const Vec3& p) -> Vec3 { return radius * bumpsphere_radius(p) * p.normalized(); };
  TriangleMesh start = sphere(radius, 4 * vertex_count);
  for (auto row : start.vertices.rowwise()) row = options.projection(row.transpose()).transpose();
  return remesh_to_vertex_count(start, vertex_count, options);
}

}  // namespace softform
