#include <CGAL/IO/facets_in_complex_2_to_triangle_mesh.h>
#include <CGAL/Implicit_surface_3.h>
#include <CGAL/Random.h>
#include <CGAL/Surface_mesh_default_triangulation_3.h>
#include <CGAL/make_surface_mesh.h>
#include <fmt/format.h>

#include "softform/core/error.hpp"
#include "softform/mesh/cgal_mesh_internal.hpp"
#include "softform/mesh/check.hpp"
#include "softform/mesh/implicit_model.hpp"
#include "softform/mesh/remesh.hpp"

namespace softform {
namespace {

using Triangulation = CGAL::Surface_mesh_default_triangulation_3;
using Traits = Triangulation::Geom_traits;

/// Delaunay refinement (CGAL's Surface_mesher) into triangles that show the shape; their number is what comes of it.
TriangleMesh first_surface(const ImplicitModel& model)
{
  const Ball bound = model.bounding_ball();
  // The mesher's lengths are of order 1 then, whatever the unit.
  const auto value = [&](const Traits::Point_3& p) {
    return model.evaluate(bound.center + bound.radius * Vec3(p.x(), p.y(), p.z())).value / bound.radius;
  };
  // Its first points come from CGAL's random numbers, seeded by the clock unless told otherwise.
  CGAL::get_default_random() = CGAL::Random(0);
  Triangulation triangulation;
  CGAL::Surface_mesh_complex_2_in_triangulation_3<Triangulation> complex(triangulation);
  const CGAL::Implicit_surface_3<Traits, decltype(value)> surface(value, Traits::Sphere_3(CGAL::ORIGIN, 1.44), 1e-7);
  // Smallest angle [degrees], largest radius of a triangle and distance from the surface.
  const CGAL::Surface_mesh_default_criteria_3<Triangulation> criteria(30, 0.015, 0.001);
  CGAL::make_surface_mesh(complex, surface, criteria, CGAL::Manifold_tag());

  cgal::SurfaceMesh mesh;
  CGAL::facets_in_complex_2_to_triangle_mesh(complex, mesh);
  TriangleMesh result = cgal::from_surface_mesh(mesh);
  result.vertices = (bound.radius * result.vertices).rowwise() + bound.center.transpose();
  return result;
}

}  // namespace

TriangleMesh mesh_model(const ImplicitModel& model, int vertex_count)
{
  const TriangleMesh first = repaired(first_surface(model));
  if (const int genus = check_mesh(first).genus.value_or(0); genus != 0)
    throw InputError(fmt::format(
        "the solid has genus {}, a balloon 0: fill the gap between the parts that form a ring, or move them "
        "apart",
        genus));
  RemeshOptions options;
  options.projection = [&model](const Vec3& p) { return projected(model, p); };
  return remesh_to_vertex_count(first, vertex_count, options);
}

}  // namespace softform
