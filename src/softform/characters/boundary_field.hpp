#pragma once

#include <vector>

#include "softform/fem/solid.hpp"

namespace softform {

/// A vertex of the boundary near a place, with its weight there and the weight's derivative by the place.
struct BoundaryWeight {
  int vertex;
  double value;
  Eigen::Vector2d gradient;  ///< [1/m]
};

/// The implicit moving least squares field of a planar body's boundary at rest (5.10; Öztireli et al. 2009), and the
/// weights by which an actuator on it is spread over its vertices (5.12), with the kernels
///     phi_k(l) = (1 - |l - X_k|^2/h^2)^4 for |l - X_k| < h, else 0.
/// On a thin part both sides are within h of each other: a place belongs to one side and sees only the kernels whose
/// normals agree with it.
class BoundaryField {
 public:
  using Place = Eigen::Vector2d;

  /// The kernels' radius h is `radius_in_edges` mean boundary edges.
  explicit BoundaryField(const PlanarSolid& body, double radius_in_edges = 2.5);

  /// h [m].
  double radius() const { return radius_; }
  /// Numbers of the boundary vertices within `distance` of the place whose normals agree with `side`.
  std::vector<int> kernels(const Place& place, const Place& side, double distance) const;
  /// Unit normal of the boundary at its vertex nearest to the place.
  Place normal(const Place& place) const;
  /// The nearest point on the boundary edges whose normals agree with `side`.
  Place projected(const Place& place, const Place& side) const;

  /// The weights (5.12) of the kernels given, in their order: zero beyond h. All NaN where none reaches.
  std::vector<BoundaryWeight> weights(const Place& place, const std::vector<int>& kernels) const;
  /// Phi [m] and its gradient, over the kernels given.
  double value(const Place& place, const std::vector<int>& kernels, Place* gradient = nullptr) const;

 private:
  std::vector<int> vertices_;  // of the boundary
  std::vector<Place> points_, normals_;
  std::vector<std::array<Place, 2>> edges_;
  double radius_ = 0;
};

}  // namespace softform
