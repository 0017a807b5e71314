#pragma once

#include <functional>

#include "softform/mesh/triangle_mesh.hpp"

namespace softform {

/// The surface f = 0 around a point of f < 0, closed and facing away from it, by marching tetrahedra (six a cube, Doi
/// and Koide 1991) on a grid of the given step: from cube to neighbouring cube along the surface, so that the cost
/// follows its area, and other components are not seen. The triangles are of all shapes; see remesh.hpp. Deterministic.
/// Throws InputError when f is not negative at `inside`, or when the surface does not end within 1000 steps of it.
TriangleMesh level_surface(const std::function<double(const Vec3&)>& f, const Vec3& inside, double step);

}  // namespace softform
