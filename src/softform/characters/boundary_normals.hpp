#pragma once

#include <utility>
#include <vector>

#include "softform/characters/boundary_field.hpp"

namespace softform {

/// A unit normal with its derivatives [1/m] by the positions of the vertices that it depends on (a vertex may come more
/// than once: the sum counts) and by the place where it was interpolated.
struct InterpolatedNormal {
  Eigen::Vector2d value;
  std::vector<std::pair<int, Eigen::Matrix2d>> by_positions;
  Eigen::Matrix2d by_place;
};

/// Outward normals of a planar body's boundary while it deforms: at a vertex that of its two edges together, between
/// vertices the mean by the weights (5.12), made a unit vector again (5.15).
class BoundaryNormals {
 public:
  explicit BoundaryNormals(const PlanarSolid& body);

  /// x: (2n) [m].
  InterpolatedNormal interpolated(const std::vector<BoundaryWeight>& weights, ConstVec x) const;

 private:
  std::vector<int> previous_, next_;  // along the boundary, the body to the left; -1 inside
};

}  // namespace softform
