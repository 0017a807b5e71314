#pragma once

#include "softform/mesh/triangle_mesh.hpp"

namespace softform {

/// The mesh without the triangles that boolean operations leave where parts meet: edges below `length` of needles are
/// collapsed and the longest edge of caps (an angle above 179.5 degrees) flipped, which moves the surface by less than
/// that. Precondition: a closed manifold. Lengths in the mesh's unit.
TriangleMesh without_slivers(const TriangleMesh& mesh, double length);

}  // namespace softform
