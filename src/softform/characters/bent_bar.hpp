#pragma once

#include <vector>

#include "softform/equilibrium/potential.hpp"
#include "softform/mesh/simplex_mesh.hpp"

namespace softform {

/// A stretch of a bar that bends evenly, with ends where its curvature fades in and out smoothly.
struct Bend {
  double begin, end;  ///< along the bar [m]
  double angle;       ///< turned between them, to the left when positive [rad]
};

/// Curvature fades over this length at both ends of a bend [m]; bends are longer than twice as much.
constexpr double bend_fade = 0.005;

/// Where the vertices of a bar along x come to lie when its centre line, at half its height y, takes these bends
/// without stretching and its sections stay plane and at right angles to it: a purely geometric target. The far end
/// keeps its direction, so that only the near end turns, and the centre of the far end stays where it is.
/// `fraction` scales the angles: from 0, the bar at rest, to 1. Returns (3n).
Vec bent_bar(const SimplexMesh<3>& bar, const std::vector<Bend>& bends, double fraction = 1);

/// Holds the vertices within `length` [m] of both ends of a bar along x: clamps that fix position and orientation
/// (5.5), when the held coordinates have rigidly moved positions.
FixedDofs end_caps(const SimplexMesh<3>& bar, double length);

}  // namespace softform
