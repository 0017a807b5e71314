#pragma once

#include <vector>

#include "softform/characters/boundary_field.hpp"
#include "softform/equilibrium/loaded_solid.hpp"

namespace softform {

struct SlidingWeights {
  double boundary = 10;     ///< of (5.11), Phi in mm
  double repulsion = 1e-2;  ///< k_rep of (5.13), lengths in mm
};

/// Places of actuators that slide on a body's boundary at rest, as variables l = (l_1, ...) in mm: what keeps them on
/// it and apart from each other,
///     w_b/2 sum_j Phi(l_j)^2 + k_rep sum_{jk} [eps - |l_j - l_k|]_+^3   (5.11, 5.13),
/// and how each is spread over the boundary's vertices (5.12). A place may move by the kernels' radius from where it
/// started: its kernels are those that reach it there, and beyond all is NaN.
class SlidingPlaces {
 public:
  /// places [m] and the outward unit normals of the sides that they belong to.
  SlidingPlaces(const BoundaryField& field, const std::vector<Point<2>>& places, const std::vector<Point<2>>& sides,
                const SlidingWeights& weights);

  int count() const { return static_cast<int>(start_.size()); }
  /// l (2 count) [mm] of the places that were given.
  Vec start() const;
  /// The weights (5.12) of place j, of the same vertices at every call.
  std::vector<BoundaryWeight> spread(ConstVec l, int j) const;
  /// Whether all places are within reach of where they started.
  bool are_within_reach(ConstVec l) const;

  double value(ConstVec l) const;
  /// g (2 count).
  void gradient(ConstVec l, Vec& g) const;
  /// The Gauss-Newton Hessian of (5.11), entries offset by `first`.
  void append_hessian(ConstVec l, int first, std::vector<Eigen::Triplet<double>>& entries) const;

 private:
  double field_value(ConstVec l, int j, Point<2>* gradient) const;
  double repulsion(ConstVec l, Vec* gradient) const;

  BoundaryField field_;
  std::vector<Point<2>> start_;
  std::vector<std::vector<int>> kernels_;  // of each place: all that can reach it while it moves
  SlidingWeights weights_;
};

/// Places moved onto the boundary itself, and the sides that they then belong to.
void project_onto_boundary(const BoundaryField& field, std::vector<Point<2>>& places, std::vector<Point<2>>& sides);

/// sum_k w_k x_k [m], where the place's material point is.
Point<2> weighted_mean(const std::vector<BoundaryWeight>& weights, ConstVec x);
/// Its derivative by the place.
Eigen::Matrix2d weighted_gradient(const std::vector<BoundaryWeight>& weights, ConstVec x);
/// The same point as what an actuator of a LoadedSolid holds.
BodyPoint spread_point(const std::vector<BoundaryWeight>& weights);

}  // namespace softform
