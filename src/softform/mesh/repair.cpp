#include <vector>

#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/repair_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <CGAL/alpha_wrap_3.h>
#include <CGAL/boost/graph/helpers.h>

#include "softform/core/error.hpp"
#include "softform/mesh/cgal_mesh_internal.hpp"
#include "softform/mesh/remesh.hpp"

namespace softform {
namespace {

namespace PMP = CGAL::Polygon_mesh_processing;
using Polygon = std::vector<std::size_t>;

struct Soup {
  std::vector<cgal::Point> points;
  std::vector<Polygon> polygons;
};

Soup soup_of(const TriangleMesh& mesh)
{
  Soup soup;
  for (int i = 0; i < mesh.vertex_count(); ++i) soup.points.push_back(cgal::point(mesh.vertices, i));
  for (int t = 0; t < mesh.triangle_count(); ++t)
    soup.polygons.emplace_back(mesh.triangles.row(t).begin(), mesh.triangles.row(t).end());
  return soup;
}

void fill_holes(cgal::SurfaceMesh& surface)
{
  std::vector<cgal::SurfaceMesh::Halfedge_index> cycles;
  PMP::extract_boundary_cycles(surface, std::back_inserter(cycles));
  for (const auto border : cycles) {
    std::vector<cgal::FaceIndex> patch;
    PMP::triangulate_hole(surface, border, std::back_inserter(patch));
  }
}

}  // namespace

TriangleMesh repaired(const TriangleMesh& mesh)
{
  Soup soup = soup_of(mesh);
  PMP::repair_polygon_soup(soup.points, soup.polygons);
  PMP::orient_polygon_soup(soup.points, soup.polygons);
  cgal::SurfaceMesh surface;
  PMP::polygon_soup_to_polygon_mesh(soup.points, soup.polygons, surface);
  PMP::keep_largest_connected_components(surface, 1);
  fill_holes(surface);
  surface.collect_garbage();
  if (surface.number_of_faces() == 0 || !CGAL::is_closed(surface))
    throw InputError("the mesh could not be closed; fill its holes in a modelling program");
  if (!PMP::is_outward_oriented(surface)) PMP::reverse_face_orientations(surface);
  return cgal::from_surface_mesh(surface);
}

TriangleMesh shrink_wrapped(const TriangleMesh& mesh, double alpha, double offset)
{
  const Soup soup = soup_of(mesh);
  cgal::SurfaceMesh wrap;
  CGAL::alpha_wrap_3(soup.points, soup.polygons, alpha, offset, wrap);
  wrap.collect_garbage();
  return cgal::from_surface_mesh(wrap);
}

}  // namespace softform
