#include "softform/mesh/polygon_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include "softform/core/error.hpp"
#include "softform/mesh/triangle_mesh.hpp"

namespace softform {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_2;
using Polygon = CGAL::Polygon_2<Kernel>;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<int, Kernel>;
using FaceBase = CGAL::Constrained_triangulation_face_base_2<Kernel>;
using Triangulation =
    CGAL::Constrained_Delaunay_triangulation_2<Kernel, CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>>;

/// Lattice points closer to the outline than this, in edge lengths, would give flat triangles.
constexpr double clearance = 0.6;
constexpr int smoothing_rounds = 10;

Polygon checked(const PlanarPositions& corners)
{
  Polygon polygon;
  for (Eigen::Index i = 0; i < corners.rows(); ++i) polygon.push_back(Point(corners(i, 0), corners(i, 1)));
  if (polygon.size() < 3) throw InputError("a polygon needs at least three corners");
  if (!polygon.is_simple()) throw InputError("the polygon crosses itself");
  if (!polygon.is_counterclockwise_oriented()) throw InputError("the polygon runs clockwise: reverse it");
  return polygon;
}

double distance_to(const Polygon& polygon, const Point& p)
{
  double least = std::numeric_limits<double>::infinity();
  for (auto edge = polygon.edges_begin(); edge != polygon.edges_end(); ++edge)
    least = std::min(least, CGAL::squared_distance(*edge, p));
  return std::sqrt(least);
}

std::vector<Point> lattice_inside(const Polygon& polygon, double edge_length)
{
  std::vector<Point> points;
  const auto box = polygon.bbox();
  const double row_height = edge_length * std::sqrt(0.75);
  int row = 0;
  for (double y = box.ymin() + 0.5 * row_height; y < box.ymax(); y += row_height, ++row) {
    for (double x = box.xmin() + (row % 2 == 0 ? 0.25 : 0.75) * edge_length; x < box.xmax(); x += edge_length) {
      const Point p(x, y);
      if (polygon.has_on_bounded_side(p) && distance_to(polygon, p) > clearance * edge_length) points.push_back(p);
    }
  }
  return points;
}

/// All vertices, the first `corner_count` around the polygon, joined to triangles inside it.
Triangles delaunay_inside(const std::vector<Point>& vertices, std::size_t corner_count, const Polygon& polygon)
{
  Triangulation triangulation;
  std::vector<Triangulation::Vertex_handle> handles;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    handles.push_back(triangulation.insert(vertices[i]));
    handles.back()->info() = static_cast<int>(i);
  }
  for (std::size_t i = 0; i < corner_count; ++i)
    triangulation.insert_constraint(handles[i], handles[(i + 1) % corner_count]);
  std::vector<Eigen::RowVector3i> inside;
  for (const auto& face : triangulation.finite_face_handles()) {
    if (!polygon.has_on_bounded_side(CGAL::centroid(triangulation.triangle(face)))) continue;
    inside.emplace_back(face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info());
  }
  Triangles triangles(static_cast<Eigen::Index>(inside.size()), 3);
  for (std::size_t t = 0; t < inside.size(); ++t) triangles.row(static_cast<Eigen::Index>(t)) = inside[t];
  return triangles;
}

}  // namespace

PlanarMesh triangulated_inside(const PlanarPositions& corners, double edge_length)
{
  const Polygon polygon = checked(corners);
  std::vector<Point> vertices(polygon.vertices_begin(), polygon.vertices_end());
  const std::vector<Point> interior = lattice_inside(polygon, edge_length);
  vertices.insert(vertices.end(), interior.begin(), interior.end());

  Triangles triangles = delaunay_inside(vertices, polygon.size(), polygon);
  for (int round = 0; round < smoothing_rounds; ++round) {
    const auto neighbours = vertex_neighbours(triangles, static_cast<int>(vertices.size()));
    for (std::size_t i = polygon.size(); i < vertices.size(); ++i) {
      double x = 0, y = 0;
      for (const int k : neighbours[i]) {
        x += vertices[static_cast<std::size_t>(k)].x();
        y += vertices[static_cast<std::size_t>(k)].y();
      }
      const auto count = static_cast<double>(neighbours[i].size());
      const Point middle(x / count, y / count);
      if (polygon.has_on_bounded_side(middle)) vertices[i] = middle;
    }
    triangles = delaunay_inside(vertices, polygon.size(), polygon);
  }

  PlanarMesh mesh{PlanarPositions(static_cast<Eigen::Index>(vertices.size()), 2), std::move(triangles)};
  for (std::size_t i = 0; i < vertices.size(); ++i)
    mesh.vertices.row(static_cast<Eigen::Index>(i)) << vertices[i].x(), vertices[i].y();
  return mesh;
}

}  // namespace softform
