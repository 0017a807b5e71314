#pragma once

#include <string>

#include "softform/mesh/simplex_mesh.hpp"
#include "softform/mesh/triangle_mesh.hpp"

namespace softform {

struct TetrahedralizeOptions {
  double largest_volume = 0;       ///< of a tetrahedron, in the surface's unit cubed; 0: no bound
  double radius_edge_ratio = 1.4;  ///< TetGen's bound on circumradius over shortest edge
  std::string program = "tetgen";
};

/// Fills a closed surface with tetrahedra by the program `tetgen` (Si 2015), run as a process of its own: it is AGPL
/// and may crash. The surface's vertices come first and stay; its edges are not split. Throws InputError naming `name`
/// when the surface is not closed, oriented and free of self-intersection, when the program is missing and when it
/// fails.
SimplexMesh<3> tetrahedralize(const TriangleMesh& surface, const std::string& name,
                              const TetrahedralizeOptions& options = {});

/// The same with about `count` tetrahedra, to within `tolerance` of it where a bound on the volume can do that: by
/// bisection on the bound. Returns the closest mesh found.
SimplexMesh<3> tetrahedralize_to_count(const TriangleMesh& surface, const std::string& name, int count,
                                       double tolerance = 0.02, const TetrahedralizeOptions& options = {});

}  // namespace softform
