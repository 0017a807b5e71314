#include "softform/mesh/polygon.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <fmt/format.h>

#include "softform/core/error.hpp"

namespace softform {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<int, Kernel>;
using FaceBase = CGAL::Constrained_triangulation_face_base_2<Kernel>;
using Delaunay =
    CGAL::Constrained_Delaunay_triangulation_2<Kernel, CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>>;
using Point = Kernel::Point_2;
using Points = std::vector<Eigen::Vector2d>;

double distance_to_segment(const Eigen::Vector2d& p, const Eigen::Vector2d& a, const Eigen::Vector2d& b)
{
  const double t = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (p - a - t * (b - a)).norm();
}

CGAL::Polygon_2<Kernel> outline_of(const Polygon& polygon)
{
  CGAL::Polygon_2<Kernel> outline;
  for (const auto& corner : polygon.rowwise()) outline.push_back(Point(corner.x(), corner.y()));
  return outline;
}

// A polygon's inside, filled with points and triangles.
class Filling {
 public:
  explicit Filling(const Polygon& polygon)
      : corner_count_(static_cast<int>(polygon.rows())), outline_(outline_of(polygon))
  {
    for (int i = 0; i < corner_count_; ++i) points_.emplace_back(polygon.row(i));
    if (!outline_.is_simple())
      throw InputError("the outline crosses or touches itself: draw it as one loop without crossings");
    if (outline_.is_clockwise_oriented()) throw InputError("the outline runs clockwise: reverse it");
  }

  // A lattice of equilateral triangles, as far as it is not too close to the boundary.
  void add_lattice(double edge)
  {
    const CGAL::Bbox_2 box = outline_.bbox();
    const double rise = edge * std::sqrt(3.0) / 2;
    for (int j = 1; box.ymin() + j * rise < box.ymax(); ++j)
      for (double x = box.xmin() + (j % 2 == 0 ? edge : edge / 2); x < box.xmax(); x += edge) {
        const Eigen::Vector2d point(x, box.ymin() + j * rise);
        if (is_inside(point) && distance_to_boundary(point) > 0.6 * edge) points_.push_back(point);
      }
  }

  Triangles triangles() const
  {
    Delaunay delaunay;
    std::vector<Delaunay::Vertex_handle> vertices;
    for (const Eigen::Vector2d& point : points_) {
      vertices.push_back(delaunay.insert(Point(point.x(), point.y())));
      vertices.back()->info() = static_cast<int>(vertices.size()) - 1;
    }
    for (int i = 0; i < corner_count_; ++i)
      delaunay.insert_constraint(vertices[std::size_t(i)], vertices[std::size_t((i + 1) % corner_count_)]);
    std::vector<std::array<int, 3>> found;
    for (const auto face : delaunay.finite_face_handles()) {
      const std::array<int, 3> t{face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()};
      if (is_inside((at(t[0]) + at(t[1]) + at(t[2])) / 3)) found.push_back(t);
    }
    Triangles triangles(Eigen::Index(found.size()), 3);
    for (std::size_t t = 0; t < found.size(); ++t)
      triangles.row(Eigen::Index(t)) << found[t][0], found[t][1], found[t][2];
    return triangles;
  }

  // Every point inside to the mean of its neighbours.
  void smooth()
  {
    const Points before = points_;
    const auto neighbours = vertex_neighbours(triangles(), static_cast<int>(points_.size()));
    for (std::size_t i = std::size_t(corner_count_); i < points_.size(); ++i) {
      Eigen::Vector2d sum = Eigen::Vector2d::Zero();
      for (const int j : neighbours[i]) sum += before[std::size_t(j)];
      if (!neighbours[i].empty()) points_[i] = sum / double(neighbours[i].size());
    }
  }

  TriangleMesh mesh() const
  {
    TriangleMesh mesh;
    mesh.vertices.setZero(Eigen::Index(points_.size()), 3);
    for (std::size_t i = 0; i < points_.size(); ++i) mesh.vertices.row(Eigen::Index(i)).head<2>() = points_[i];
    mesh.triangles = triangles();
    return mesh;
  }

 private:
  const Eigen::Vector2d& at(int i) const { return points_[std::size_t(i)]; }
  bool is_inside(const Eigen::Vector2d& p) const
  {
    return outline_.bounded_side(Point(p.x(), p.y())) == CGAL::ON_BOUNDED_SIDE;
  }
  double distance_to_boundary(const Eigen::Vector2d& p) const
  {
    double smallest = std::numeric_limits<double>::infinity();
    for (int i = 0; i < corner_count_; ++i)
      smallest = std::min(smallest, distance_to_segment(p, at(i), at((i + 1) % corner_count_)));
    return smallest;
  }

  int corner_count_;
  Points points_;  // the corners first
  CGAL::Polygon_2<Kernel> outline_;
};

}  // namespace

double signed_area(const Polygon& polygon)
{
  double twice = 0;
  for (Eigen::Index i = 0, j = polygon.rows() - 1; i < polygon.rows(); j = i++)
    twice += polygon(j, 0) * polygon(i, 1) - polygon(i, 0) * polygon(j, 1);
  return twice / 2;
}

bool is_simple(const Polygon& polygon) { return outline_of(polygon).is_simple(); }

double perimeter(const Polygon& polygon)
{
  double length = 0;
  for (Eigen::Index i = 0, j = polygon.rows() - 1; i < polygon.rows(); j = i++)
    length += (polygon.row(i) - polygon.row(j)).norm();
  return length;
}

TriangleMesh triangulated(const Polygon& polygon, double edge_length)
{
  if (!(edge_length > 0) || polygon.rows() < 3)
    throw InputError(
        fmt::format("a polygon of {} corners with edges of {} m: give 3 corners or more and a positive length",
                    polygon.rows(), edge_length));
  Filling filling(polygon);
  filling.add_lattice(edge_length);
  for (int pass = 0; pass < 4; ++pass) filling.smooth();
  return filling.mesh();
}

}  // namespace softform
