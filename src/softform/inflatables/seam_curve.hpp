#pragma once

#include <string>
#include <vector>

#include "softform/inflatables/seam_file.hpp"
#include "softform/mesh/geodesic.hpp"

namespace softform {

/// The part of a drawn seam between two places where seams meet or end.
struct SeamSegment {
  std::string name;        ///< of the seam, with its number along it where there are several
  int seam = 0;            ///< in the plan
  int start = 0, end = 0;  ///< nodes of the network; the same for a closed seam that meets no other
  Positions points;        ///< (n, 3) on the target, from the start node to the end node
};

/// Drawn seams as curves on the target, broken where they meet.
struct SeamNetwork {
  Positions nodes;  ///< (k, 3)
  std::vector<SeamSegment> segments;
};

/// Lays seams on a target. Between two points a seam is a geodesic; through several it is bent as a cubic Hermite
/// spline is against its chords, so that it has no kinks: in a plane it is that spline, its tangents those of the
/// parabolas through three points. Seams with a point in common meet there; others must stay apart.
/// `resolution` [m] is the length of an edge of the mesh to be cut: what is closer than half of it does not count as
/// apart. Throws InputError naming the seams and the place when a point is off the target by more than the resolution,
/// seams cross or touch without a common point, or a seam crosses itself.
SeamNetwork lay_seams(const Geodesics& target, const SeamPlan& plan, double resolution);

/// "(1.5, 0, 2)", for messages.
std::string place(const Vec3& point);

}  // namespace softform
