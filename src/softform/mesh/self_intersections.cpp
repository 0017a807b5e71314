#include "softform/mesh/self_intersections.hpp"

#include <algorithm>
#include <iterator>

#include <CGAL/Polygon_mesh_processing/self_intersections.h>

#include "softform/core/error.hpp"
#include "softform/mesh/cgal_mesh_internal.hpp"

namespace softform {

std::vector<std::pair<int, int>> self_intersections(const TriangleMesh& mesh)
{
  const auto surface = cgal::to_surface_mesh(mesh);
  if (!surface)
    throw InputError("self-intersections are looked for on oriented manifold surfaces only; repair the mesh");

  std::vector<std::pair<cgal::FaceIndex, cgal::FaceIndex>> faces;
  CGAL::Polygon_mesh_processing::self_intersections(*surface, std::back_inserter(faces));
  std::vector<std::pair<int, int>> pairs;
  for (const auto& [a, b] : faces)
    pairs.emplace_back(std::minmax(static_cast<int>(a.idx()), static_cast<int>(b.idx())));
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

int count_self_intersections(const TriangleMesh& mesh) { return static_cast<int>(self_intersections(mesh).size()); }

}  // namespace softform
