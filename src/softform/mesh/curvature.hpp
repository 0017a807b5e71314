#pragma once

#include "softform/mesh/triangle_mesh.hpp"

namespace softform {

/// Mean curvature of a closed surface at its vertices (n) [1/m], positive where it is convex: half the cotangent
/// Laplacian of the positions, per vertex area, along the normal (Meyer et al. 2003; a third of the ring's area).
Vec mean_curvature(const TriangleMesh& mesh);

/// The largest distance [m] between a surface and its mirror images in the coordinate planes through its centroid.
double mirror_asymmetry(const TriangleMesh& mesh);

}  // namespace softform
