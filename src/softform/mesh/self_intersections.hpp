#pragma once

#include <utility>
#include <vector>

#include "softform/mesh/triangle_mesh.hpp"

namespace softform {

/// The pairs of triangles that cut each other (beyond a shared vertex or edge), each pair once and sorted; exact
/// predicates. Throws InputError when the triangles are no oriented manifold.
std::vector<std::pair<int, int>> self_intersections(const TriangleMesh& mesh);

/// The number of those pairs.
int count_self_intersections(const TriangleMesh& mesh);

}  // namespace softform
