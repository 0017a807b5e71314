#include "softform/mesh/triangulate.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iterator>

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Delaunay_mesh_face_base_2.h>
#include <CGAL/Delaunay_mesh_size_criteria_2.h>
#include <CGAL/Delaunay_mesh_vertex_base_2.h>
#include <CGAL/Delaunay_mesher_2.h>
#include <CGAL/Delaunay_mesher_no_edge_refinement_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/lloyd_optimize_mesh_2.h>
#include <fmt/format.h>

#include "softform/core/error.hpp"
#include "softform/mesh/polygon.hpp"
#include "softform/mesh/relax.hpp"

namespace softform {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
// Vertices with a time stamp are sorted by age, not by address: Lloyd's iterations then move them in the same order
// whatever the heap looks like. (Faces have one anyway.)
template <class Base>
struct Stamped : Base {
  using Base::Base;
  template <class Structure>
  struct Rebind_TDS {  // NOLINT(readability-identifier-naming): CGAL's name
    using Other = Stamped<typename Base::template Rebind_TDS<Structure>::Other>;
  };
  using Has_timestamp = CGAL::Tag_true;
  std::size_t time_stamp() const { return time_stamp_; }
  void set_time_stamp(std::size_t stamp) { time_stamp_ = stamp; }

 private:
  std::size_t time_stamp_ = static_cast<std::size_t>(-1);  // none yet, in CGAL's convention
};
using Triangulation = CGAL::Constrained_Delaunay_triangulation_2<
    Kernel,
    CGAL::Triangulation_data_structure_2<Stamped<CGAL::Delaunay_mesh_vertex_base_2<Kernel>>,
                                         CGAL::Delaunay_mesh_face_base_2<Kernel>>,
    CGAL::No_constraint_intersection_tag>;
using Criteria = CGAL::Delaunay_mesh_size_criteria_2<Triangulation>;
using Point = Triangulation::Point;

constexpr double aspect_bound = 0.125;  // B^2 / 4 with B = 1/sqrt(2): angles above 20.7 degrees, termination is proven
constexpr int lloyd_iterations = 10;

// A point inside the polygon: the middle of its longest chord at a height that meets no vertex.
Point interior_point(const PlanarPositions& polygon)
{
  std::vector<double> heights(polygon.col(1).begin(), polygon.col(1).end());
  std::sort(heights.begin(), heights.end());
  const std::size_t middle = heights.size() / 2;
  const double y = (heights[middle - 1] + heights[middle]) / 2;
  std::vector<double> crossings;
  for (Eigen::Index i = 0; i < polygon.rows(); ++i) {
    const auto a = polygon.row(i), b = polygon.row((i + 1) % polygon.rows());
    if ((a.y() < y) != (b.y() < y)) crossings.push_back(a.x() + (y - a.y()) / (b.y() - a.y()) * (b.x() - a.x()));
  }
  std::sort(crossings.begin(), crossings.end());
  std::size_t widest = 0;
  for (std::size_t k = 0; k + 1 < crossings.size(); k += 2)
    if (crossings[k + 1] - crossings[k] > crossings[widest + 1] - crossings[widest]) widest = k;
  return {(crossings[widest] + crossings[widest + 1]) / 2, y};
}

using Handles = std::vector<Triangulation::Vertex_handle>;

Handles insert_polygon(const PlanarPositions& polygon, Triangulation& triangulation)
{
  Handles handles;
  for (const auto& row : polygon.rowwise()) handles.push_back(triangulation.insert({row.x(), row.y()}));
  for (std::size_t i = 0; i < handles.size(); ++i)
    triangulation.insert_constraint(handles[i], handles[(i + 1) % handles.size()]);
  return handles;
}

// The triangles inside; vertices are numbered as they appear there, after those of `first`.
PlanarMesh inside_of(const Triangulation& triangulation, const Handles& first = {})
{
  CGAL::Unique_hash_map<Triangulation::Vertex_handle, int> index(-1);
  std::vector<Point> points;
  for (const auto& handle : first) {
    index[handle] = static_cast<int>(points.size());
    points.push_back(handle->point());
  }
  std::vector<Eigen::RowVector3i> triangles;
  for (const auto face : triangulation.finite_face_handles()) {
    if (!face->is_in_domain()) continue;
    Eigen::RowVector3i triangle;
    for (int k = 0; k < 3; ++k) {
      int& i = index[face->vertex(k)];
      if (i < 0) {
        i = static_cast<int>(points.size());
        points.push_back(face->vertex(k)->point());
      }
      triangle[k] = i;
    }
    triangles.push_back(triangle);
  }
  PlanarMesh mesh;
  mesh.positions.resize(2 * static_cast<Eigen::Index>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i)
    mesh.positions.segment<2>(2 * static_cast<Eigen::Index>(i)) << points[i].x(), points[i].y();
  mesh.elements.resize(static_cast<Eigen::Index>(triangles.size()), 3);
  for (Eigen::Index t = 0; t < mesh.elements.rows(); ++t) mesh.elements.row(t) = triangles[static_cast<std::size_t>(t)];
  return mesh;
}

std::vector<PlanarPositions> sampled(const Outline& outline, double spacing)
{
  std::vector<PlanarPositions> polygons;
  for (const OutlineLoop& loop : outline) polygons.push_back(sample(loop, spacing));
  return polygons;
}

double area_of(const Outline& outline)
{
  double extent = 0;
  for (const OutlinePoint& point : outline.front())
    extent = std::max(extent, (point.position - outline.front().front().position).norm());
  double area = 0;
  for (std::size_t i = 0; i < outline.size(); ++i)
    area += (i == 0 ? 1 : -1) * std::abs(signed_area(sample(outline[i], 1e-2 * extent)));
  return area;
}

// The triangulation before its vertices are relaxed; returns seeds of the holes.
std::vector<Point> refine(const std::vector<PlanarPositions>& polygons, double edge_length,
                          Triangulation& triangulation)
{
  for (std::size_t i = 0; i < polygons.size(); ++i)
    if (polygons[i].rows() < 3 || !(std::abs(signed_area(polygons[i])) > 0))
      throw InputError(fmt::format("loop {} of the outline encloses no area: draw it through three points or more", i));
  try {
    for (const PlanarPositions& polygon : polygons) insert_polygon(polygon, triangulation);
  } catch (const Triangulation::Intersection_of_constraints_exception&) {
    throw InputError("the outline crosses itself: move its points, or add some where the curve is to bend");
  }
  std::vector<Point> holes;
  for (std::size_t i = 1; i < polygons.size(); ++i) holes.push_back(interior_point(polygons[i]));
  CGAL::refine_Delaunay_mesh_2(triangulation, holes.begin(), holes.end(), Criteria(aspect_bound, edge_length));
  return holes;
}

int count_inside(const Triangulation& triangulation)
{
  int count = 0;
  for (const auto face : triangulation.finite_face_handles()) count += face->is_in_domain() ? 1 : 0;
  return count;
}

double smallest_planar_quality(const PlanarMesh& mesh)
{
  Vec x = Vec::Zero(3 * Eigen::Index(mesh.vertex_count()));
  for (int i = 0; i < mesh.vertex_count(); ++i) x.segment<2>(3 * i) = mesh.positions.segment<2>(2 * i);
  return smallest_quality(x, mesh.elements);
}

}  // namespace

PlanarMesh triangulate(const std::vector<PlanarPositions>& polygons, double edge_length)
{
  Triangulation triangulation;
  const std::vector<Point> holes = refine(polygons, edge_length, triangulation);
  CGAL::lloyd_optimize_mesh_2(triangulation, CGAL::parameters::max_iteration_number = lloyd_iterations,
                              CGAL::parameters::seeds_begin = holes.begin(), CGAL::parameters::seeds_end = holes.end());
  return inside_of(triangulation);
}

PlanarMesh triangulate_inside(const PlanarPositions& polygon, double edge_length)
{
  // Circumcentres lie closer than the longest edge: with this bound triangles cover, on average, what equilateral ones
  // of `edge_length` do (measured, +-10 %).
  constexpr double longest_edge = 1.48;
  Triangulation triangulation;
  const auto corners = insert_polygon(polygon, triangulation);
  CGAL::refine_Delaunay_mesh_2_without_edge_refinement(triangulation,
                                                       Criteria(aspect_bound, longest_edge * edge_length));
  const PlanarMesh refined = inside_of(triangulation, corners);
  CGAL::lloyd_optimize_mesh_2(triangulation, CGAL::parameters::max_iteration_number = lloyd_iterations);
  const PlanarMesh relaxed = inside_of(triangulation, corners);
  const auto boundary = triangulation.constrained_edges();
  const bool is_undivided = std::distance(boundary.begin(), boundary.end()) == polygon.rows();
  // A vertex that Lloyd moves onto the boundary would divide an edge there.
  return is_undivided && smallest_planar_quality(relaxed) > smallest_planar_quality(refined) ? relaxed : refined;
}

PlanarMesh triangulate_to_count(const Outline& outline, int triangle_count)
{
  constexpr int searches = 12, tries = 200;
  constexpr double step = 1e-3, tolerance = 0.02;
  // Equilateral triangles of edge h cover sqrt(3)/4 h^2 each.
  double h = std::sqrt(4 / std::sqrt(3.0) * area_of(outline) / triangle_count), best_h = h;
  int best = 0;
  const auto attempt = [&] {  // relaxation keeps the count
    Triangulation triangulation;
    refine(sampled(outline, h), h, triangulation);
    const int count = count_inside(triangulation);
    if (std::abs(count - triangle_count) < std::abs(best - triangle_count)) {
      best = count;
      best_h = h;
    }
    return count;
  };
  for (int i = 0; i < searches && best != triangle_count; ++i)
    h *= std::sqrt(static_cast<double>(attempt()) / triangle_count);
  const double centre = best_h;
  for (int i = 1; i <= tries && best != triangle_count; ++i) {
    const int steps = (i % 2 == 0 ? 1 : -1) * ((i + 1) / 2);
    h = centre * (1 + steps * step);
    attempt();
  }
  if (std::abs(best - triangle_count) > tolerance * triangle_count)
    throw InputError(
        fmt::format("the outline gives {} triangles rather than {}: it has details finer than those; ask for more or "
                    "draw it simpler",
                    best, triangle_count));
  return triangulate(sampled(outline, best_h), best_h);
}

}  // namespace softform
