#pragma once

#include <vector>

#include "softform/mesh/planar_mesh.hpp"

namespace softform {

/// A point that an outline passes through; the curve is smooth there unless it is a corner.
struct OutlinePoint {
  Eigen::Vector2d position;  ///< [m]
  bool is_corner = false;
};

/// A closed curve: cubic Hermite segments between consecutive points with the tangents of Catmull and Rom (1974), the
/// end tangents at a corner along the chord; two neighbouring corners are joined by a straight line.
using OutlineLoop = std::vector<OutlinePoint>;

/// A region of the plane: its outer boundary first, then its holes.
using Outline = std::vector<OutlineLoop>;

/// Points (n, 2) on the closed curve, at most `spacing` [m] apart along it and equally far between two corners; every
/// corner is one of them. Precondition: three points at least, spacing > 0.
PlanarPositions sample(const OutlineLoop& loop, double spacing);

}  // namespace softform
