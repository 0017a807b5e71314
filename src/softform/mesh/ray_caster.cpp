#include "softform/mesh/ray_caster.hpp"

#include <cmath>
#include <vector>

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <Eigen/Geometry>

#include "softform/mesh/cgal_mesh_internal.hpp"

namespace softform {
namespace {

using cgal::Kernel;
using TriangleList = std::vector<Kernel::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, TriangleList::const_iterator>;
using AabbTree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

TriangleList triangle_list(const TriangleMesh& mesh)
{
  TriangleList list;
  for (int t = 0; t < mesh.triangle_count(); ++t)
    list.emplace_back(cgal::point(mesh.vertices, mesh.triangles(t, 0)),
                      cgal::point(mesh.vertices, mesh.triangles(t, 1)),
                      cgal::point(mesh.vertices, mesh.triangles(t, 2)));
  return list;
}

}  // namespace

struct RayCaster::Tree {
  explicit Tree(const TriangleMesh& surface)
      : mesh(surface), triangles(triangle_list(surface)), aabb(triangles.begin(), triangles.end())
  {
    aabb.build();
  }
  TriangleMesh mesh;
  TriangleList triangles;
  AabbTree aabb;
};

RayCaster::RayCaster(const TriangleMesh& mesh) : tree_(std::make_unique<Tree>(mesh)) {}
RayCaster::RayCaster(RayCaster&&) noexcept = default;
RayCaster& RayCaster::operator=(RayCaster&&) noexcept = default;
RayCaster::~RayCaster() = default;

std::optional<double> RayCaster::from_triangle(int t, const Vec3& direction) const
{
  const Vec3 origin = middle(t);
  const Kernel::Ray_3 ray({origin.x(), origin.y(), origin.z()},
                          Kernel::Vector_3(direction.x(), direction.y(), direction.z()));
  const auto own = tree_->triangles.begin() + t;
  const auto hit =
      tree_->aabb.first_intersection(ray, [own](TriangleList::const_iterator other) { return other == own; });
  if (!hit) return std::nullopt;
  const auto distance = [&origin](const cgal::Point& p) { return (Vec3(p.x(), p.y(), p.z()) - origin).norm(); };
  if (const auto* point = boost::get<cgal::Point>(&hit->first)) return distance(*point);
  return distance(boost::get<Kernel::Segment_3>(hit->first).source());
}

Vec3 RayCaster::middle(int t) const
{
  return tree_->mesh.vertices(tree_->mesh.triangles.row(t), Eigen::all).colwise().mean();
}

Vec3 RayCaster::normal(int t) const
{
  const auto corner = [&](int k) -> Vec3 { return tree_->mesh.vertices.row(tree_->mesh.triangles(t, k)); };
  return (corner(1) - corner(0)).cross(corner(2) - corner(0)).normalized();
}

}  // namespace softform
