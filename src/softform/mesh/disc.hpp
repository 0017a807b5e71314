#pragma once

#include "softform/mesh/triangle_mesh.hpp"

namespace softform {

/// A flat disc about the origin in the plane z = 0, facing +z, of nearly equilateral triangles: ring k of `rings` holds
/// 6 k vertices at the distance k radius/rings from the centre, 1 + 3 rings (rings + 1) in all. Vertex 0 is the centre;
/// the last 6 rings vertices are the rim. Throws InputError unless radius > 0 and rings >= 2.
TriangleMesh disc(double radius, int rings);

/// The number of vertices of disc(radius, rings).
constexpr int disc_vertex_count(int rings) { return 1 + 3 * rings * (rings + 1); }

}  // namespace softform
