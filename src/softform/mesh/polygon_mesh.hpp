#pragma once

#include "softform/mesh/planar_mesh.hpp"

namespace softform {

/// A constrained Delaunay mesh of a polygon (b, 2), counter-clockwise, whose corners come first and are the only
/// vertices on its outline, so that neighbours can share them: inside, a triangular lattice of about `edge_length` [m],
/// smoothed. Throws InputError when the polygon has fewer than three corners, crosses itself or is clockwise.
PlanarMesh triangulated_inside(const PlanarPositions& polygon, double edge_length);

}  // namespace softform
