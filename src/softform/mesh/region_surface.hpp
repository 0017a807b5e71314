#pragma once

#include <vector>

#include "softform/mesh/simplex_mesh.hpp"
#include "softform/mesh/triangle_mesh.hpp"

namespace softform {

/// What happens where a region touches itself in an edge or a vertex only.
struct ContactOptions {
  /// The copies of a split vertex are drawn apart by this much [m], less than printers resolve: files of triangles
  /// without connectivity (STL) would join them again. At most a twentieth of the shortest edge there; 0 leaves them in
  /// place, and the volume exact.
  double gap = 1e-5;
  /// Copies keep their third coordinate: the top and the bottom of a plate stay flat.
  bool keeps_height = false;
};

/// The surface of a region of a body of tetrahedra, made a closed manifold.
struct RegionSurface {
  TriangleMesh mesh;       ///< every edge has two triangles, every vertex one fan; faces outwards
  int split_vertices = 0;  ///< vertices that there are several copies of
  int split_edges = 0;     ///< edges with a copy, halved, for each of the parts that touch there
};

/// The boundary of the elements chosen, oriented outwards. At an edge with more than two boundary triangles those that
/// bound the same wedge of the region stay together, and so the region is cut apart where it touches itself: a vertex
/// gets a copy for every fan that remains, and edges whose copies still have the same two ends are halved.
/// `is_inside`: one entry an element. Precondition: one is true at least.
RegionSurface region_surface(const SimplexMesh<3>& body, const std::vector<bool>& is_inside,
                             const ContactOptions& options = {});

}  // namespace softform
