#include "softform/mesh/remesh.hpp"

#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include <CGAL/Polygon_mesh_processing/detect_features.h>
#include <CGAL/Polygon_mesh_processing/remesh.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Constrained_placement.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Count_stop_predicate.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Edge_length_cost.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Midpoint_placement.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>
#include <fmt/format.h>

#include "softform/core/error.hpp"
#include "softform/mesh/cgal_mesh_internal.hpp"
#include "softform/mesh/distance.hpp"
#include "softform/mesh/self_intersections.hpp"

namespace softform {
namespace {

namespace PMP = CGAL::Polygon_mesh_processing;
namespace Collapse = CGAL::Surface_mesh_simplification;
using cgal::SurfaceMesh;
using Features = SurfaceMesh::Property_map<cgal::EdgeIndex, bool>;
using Projection = std::function<Vec3(const Vec3&)>;

/// A mesh under work, its sharp edges and the surface that its vertices belong on.
class Remesher {
  // First, because a deduced return type must be known before its use.
  /// CGAL's own projection would go to the surface at the time of the call, and so drift.
  auto parameters()
  {
    return CGAL::parameters::edge_is_constrained_map(features_).protect_constraints(true).projection_functor(
        [this](cgal::VertexIndex v) {
          const cgal::Point& p = surface_.point(v);
          const Vec3 q = projection_({p.x(), p.y(), p.z()});
          return cgal::Point(q.x(), q.y(), q.z());
        });
  }

 public:
  Remesher(const TriangleMesh& mesh, double feature_angle, const Projection& projection)
      : surface_(*cgal::to_surface_mesh(mesh)), projection_(projection)
  {
    features_ = surface_.add_property_map<cgal::EdgeIndex, bool>("e:is_feature", false).first;
    if (feature_angle < 180) PMP::detect_sharp_edges(surface_, feature_angle, features_);
  }

  int vertex_count() const { return static_cast<int>(surface_.number_of_vertices()); }

  TriangleMesh result() const { return cgal::from_surface_mesh(surface_); }

  void remesh(double edge_length, unsigned iterations)
  {
    PMP::isotropic_remeshing(surface_.faces(), edge_length, surface_, parameters().number_of_iterations(iterations));
    surface_.collect_garbage();
  }

  /// Collapses the shortest edges until `count` vertices are left. Every collapse takes three edges with it.
  void collapse_to(int count)
  {
    using Placement = Collapse::Constrained_placement<Collapse::Midpoint_placement<SurfaceMesh>, Features>;
    const std::size_t surplus = surface_.number_of_vertices() - static_cast<std::size_t>(count);
    const Collapse::Count_stop_predicate<SurfaceMesh> stop(surface_.number_of_edges() - 3 * surplus + 1);
    Collapse::edge_collapse(surface_, stop,
                            CGAL::parameters::get_cost(Collapse::Edge_length_cost<SurfaceMesh>())
                                .get_placement(Placement(features_))
                                .edge_is_constrained_map(features_));
    surface_.collect_garbage();
  }

  /// Flips edges and moves vertices along the surface; their number stays.
  void relax(unsigned iterations)
  {
    PMP::isotropic_remeshing(
        surface_.faces(), 1.0, surface_,
        parameters().number_of_iterations(iterations).number_of_relaxation_steps(3).do_split(false).do_collapse(false));
    surface_.collect_garbage();
  }

 private:
  SurfaceMesh surface_;
  Features features_;
  const Projection& projection_;
};

/// The edge length at which equilateral triangles cover the area with V vertices: 2V triangles of sqrt(3)/4 l^2.
double edge_length_for(double area, int vertex_count) { return std::sqrt(2 * area / (std::sqrt(3.0) * vertex_count)); }

/// One attempt; `surplus` is how many more vertices the isotropic mesh has, for example 0.02.
TriangleMesh attempt(const TriangleMesh& mesh, int vertex_count, double surplus, const RemeshOptions& options,
                     const Projection& projection)
{
  const double wanted = (1 + surplus) * vertex_count;
  double length = edge_length_for(surface_area(flatten(mesh.vertices), mesh.triangles), static_cast<int>(wanted));
  for (int correction = 0; correction < 8; ++correction) {
    Remesher remesher(mesh, options.feature_angle, projection);
    // Edges of one length would be split all or none: a finer mesh first makes the count follow the length.
    remesher.remesh(0.7 * length, 2);
    remesher.remesh(length, 6);
    const int reached = remesher.vertex_count();
    if (reached >= vertex_count && reached <= (1 + 2 * surplus) * vertex_count) {
      remesher.collapse_to(vertex_count);
      remesher.relax(10);
      return remesher.result();
    }
    length *= std::sqrt(reached / wanted);
  }
  return {};
}

/// What is wrong with a result, or nothing.
std::string shortcoming(const TriangleMesh& mesh, int vertex_count, double min_angle)
{
  if (mesh.vertex_count() != vertex_count) return "another number of vertices";
  if (const double angle = smallest_angle(mesh); !(angle > min_angle))
    return fmt::format("a smallest angle of {:.1f} degrees", angle);
  if (const int pairs = count_self_intersections(mesh); pairs > 0) return fmt::format("{} self-intersections", pairs);
  return {};
}

}  // namespace

double smallest_angle(const TriangleMesh& mesh)
{
  double largest_cosine = -1;
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const Vec3 origin = mesh.vertices.row(mesh.triangles(t, k));
      const Vec3 a = mesh.vertices.row(mesh.triangles(t, (k + 1) % 3)).transpose() - origin;
      const Vec3 b = mesh.vertices.row(mesh.triangles(t, (k + 2) % 3)).transpose() - origin;
      const double cosine = a.dot(b) / (a.norm() * b.norm());
      if (!(cosine <= largest_cosine)) largest_cosine = cosine;
    }
  }
  return std::acos(std::min(largest_cosine, 1.0)) * 180 / std::numbers::pi;
}

TriangleMesh remesh_to_vertex_count(const TriangleMesh& mesh, int vertex_count, const RemeshOptions& options)
{
  const auto edge_count = static_cast<int>(edges_of(mesh.triangles, mesh.vertex_count()).size());
  if (mesh.vertex_count() - edge_count + mesh.triangle_count() != 2)
    throw InputError("remeshing wants a surface of genus 0; close the tunnels by shrink_wrapped() first");

  Projection projection = options.projection;
  if (!projection) {
    const auto surface = std::make_shared<SurfaceDistance>(mesh);
    projection = [surface](const Vec3& p) { return surface->closest(p).position; };
  }
  // Another surplus gives another triangulation: the few bad triangles of one are not in the next.
  std::string reason;
  for (const double surplus : {0.02, 0.03, 0.04, 0.05, 0.07, 0.1, 0.15}) {
    const TriangleMesh result = attempt(mesh, vertex_count, surplus, options, projection);
    reason = shortcoming(result, vertex_count, options.min_angle);
    if (reason.empty()) return result;
  }
  throw InputError(fmt::format("no mesh of {} vertices was found: the last attempt has {}; ask for more vertices",
                               vertex_count, reason));
}

}  // namespace softform
