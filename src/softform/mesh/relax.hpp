#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "softform/mesh/triangle_mesh.hpp"

namespace softform {

/// Better-shaped triangles around edges that stay: in every round, edges that are no Delaunay edges are flipped and the
/// free vertices move to the middle of their neighbours in the tangent plane and onto the surface. Numbers of vertices
/// and triangles stay, vertices keep their indices. Precondition: the mesh is closed and oriented.
TriangleMesh relaxed(const TriangleMesh& mesh, const std::vector<std::pair<int, int>>& fixed_edges,
                     const std::function<Vec3(const Vec3&)>& projection, int rounds);

/// The shape quality of every triangle (m), 4 sqrt(3) area / sum of squared edge lengths: 1 for an equilateral one, 0
/// for a degenerate one.
Vec triangle_quality(ConstVec x, const Triangles& triangles);

/// The smallest of them; NaN when one is. Precondition: at least one triangle.
double smallest_quality(ConstVec x, const Triangles& triangles);

}  // namespace softform
