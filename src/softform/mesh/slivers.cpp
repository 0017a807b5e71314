#include "softform/mesh/slivers.hpp"

#include <cmath>
#include <numbers>

#include <CGAL/Polygon_mesh_processing/repair_degeneracies.h>

#include "softform/core/error.hpp"
#include "softform/mesh/cgal_mesh_internal.hpp"

namespace softform {

TriangleMesh without_slivers(const TriangleMesh& mesh, double length)
{
  auto surface = cgal::to_surface_mesh(mesh);
  if (!surface) throw InputError("the surface is no oriented manifold: repair it");
  const double cap_cosine = std::cos(179.5 / 180 * std::numbers::pi);
  constexpr double needle_ratio = 50;
  CGAL::Polygon_mesh_processing::experimental::remove_almost_degenerate_faces(*surface, cap_cosine, needle_ratio,
                                                                              length);
  surface->collect_garbage();
  return cgal::from_surface_mesh(*surface);
}

}  // namespace softform
