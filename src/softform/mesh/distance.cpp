#include "softform/mesh/distance.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>
#include <Eigen/Geometry>

#include "softform/core/parallel.hpp"

namespace softform {
namespace {

// Distances need no exact predicates: plain doubles are twice as fast.
using Kernel = CGAL::Simple_cartesian<double>;
using TriangleList = std::vector<Kernel::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, TriangleList::const_iterator>;
using AabbTree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

TriangleList triangle_list(const TriangleMesh& mesh)
{
  TriangleList list;
  list.reserve(static_cast<std::size_t>(mesh.triangle_count()));
  const auto corner = [&](int t, int k) {
    const auto row = mesh.vertices.row(mesh.triangles(t, k));
    return Kernel::Point_3(row[0], row[1], row[2]);
  };
  for (int t = 0; t < mesh.triangle_count(); ++t) list.emplace_back(corner(t, 0), corner(t, 1), corner(t, 2));
  return list;
}

}  // namespace

struct SurfaceDistance::Tree {
  explicit Tree(const TriangleMesh& mesh) : triangles(triangle_list(mesh)), aabb(triangles.begin(), triangles.end())
  {
    // Everything that CGAL would build at the first query is built here: queries stay free of writes.
    aabb.build();
    aabb.accelerate_distance_queries();
  }

  TriangleList triangles;
  AabbTree aabb;
};

SurfaceDistance::SurfaceDistance(const TriangleMesh& mesh) : tree_(std::make_unique<Tree>(mesh)) {}
SurfaceDistance::SurfaceDistance(SurfaceDistance&&) noexcept = default;
SurfaceDistance& SurfaceDistance::operator=(SurfaceDistance&&) noexcept = default;
SurfaceDistance::~SurfaceDistance() = default;

ClosestPoint SurfaceDistance::closest(const Vec3& point) const
{
  const auto [q, primitive] = tree_->aabb.closest_point_and_primitive({point.x(), point.y(), point.z()});
  const Vec3 position(q.x(), q.y(), q.z());
  const auto n =
      CGAL::cross_product(primitive->vertex(1) - primitive->vertex(0), primitive->vertex(2) - primitive->vertex(0));
  return {position, static_cast<int>(primitive - tree_->triangles.begin()), Vec3(n.x(), n.y(), n.z()).normalized(),
          (position - point).norm()};
}

std::vector<ClosestPoint> SurfaceDistance::closest_points(const Positions& points) const
{
  std::vector<ClosestPoint> result(static_cast<std::size_t>(points.rows()));
  parallel_for(static_cast<int>(points.rows()),
               [&](int i) { result[static_cast<std::size_t>(i)] = closest(points.row(i)); });
  return result;
}

Vec SurfaceDistance::distances(const Positions& points) const
{
  Vec result(points.rows());
  parallel_for(static_cast<int>(points.rows()), [&](int i) { result[i] = distance(points.row(i)); });
  return result;
}

Positions sample_surface(const TriangleMesh& mesh, int count)
{
  std::vector<double> area_up_to;
  double total = 0;
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    const Vec3 a = mesh.vertices.row(mesh.triangles(t, 0));
    const Vec3 b = mesh.vertices.row(mesh.triangles(t, 1));
    const Vec3 c = mesh.vertices.row(mesh.triangles(t, 2));
    area_up_to.push_back(total += 0.5 * (b - a).cross(c - a).norm());
  }

  // R2 sequence (M. Roberts 2018): multiples of the powers of 1/g, g^3 = g + 1.
  constexpr double g = 1.32471795724474602596;
  Positions samples(count, 3);
  std::size_t t = 0;
  for (int i = 0; i < count; ++i) {
    while (t + 1 < area_up_to.size() && area_up_to[t] < (i + 0.5) / count * total) ++t;
    double u = std::fmod(0.5 + (i + 1) / g, 1.0);
    double v = std::fmod(0.5 + (i + 1) / (g * g), 1.0);
    if (u + v > 1) u = 1 - u, v = 1 - v;
    const auto corner = [&](int k) { return mesh.vertices.row(mesh.triangles(static_cast<Eigen::Index>(t), k)); };
    samples.row(i) = (1 - u - v) * corner(0) + u * corner(1) + v * corner(2);
  }
  return samples;
}

ShapeDistance sampled_distance(const TriangleMesh& surface, const SurfaceDistance& target, int samples)
{
  const Vec distances = target.distances(sample_surface(surface, samples));
  return {distances.mean(), distances.maxCoeff<Eigen::PropagateNaN>()};
}

double hausdorff_distance(const TriangleMesh& a, const TriangleMesh& b, int samples)
{
  const auto one_way = [samples](const TriangleMesh& from, const TriangleMesh& to) {
    const SurfaceDistance distance(to);
    return std::max(distance.distances(from.vertices).maxCoeff(),
                    distance.distances(sample_surface(from, samples)).maxCoeff());
  };
  return std::max(one_way(a, b), one_way(b, a));
}

}  // namespace softform
