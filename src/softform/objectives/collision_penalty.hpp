#pragma once

#include <vector>

#include "softform/core/types.hpp"
#include "softform/objectives/objective.hpp"

namespace softform {

/// The penalty (4.15) on vertices that come closer than a threshold without being neighbours on the surface,
///     E = sum_{pairs} ((eps - |x_i - x_j|) / eps)^3 / n    where |x_i - x_j| < eps, else 0
/// (the thesis prints the bracket with the other sign, which would attract). C2. Pairs are found with a k-d tree; those
/// whose distance along the edges of the rest surface is below `geodesic` are neighbours and left out.
class CollisionPenalty : public Objective {
 public:
  /// rest_positions (3n) [m] define the geodesic distances; `threshold` is eps and `geodesic` eps_gd, both in metres.
  CollisionPenalty(const Triangles& triangles, ConstVec rest_positions, double threshold, double geodesic);

  double value(ConstVec x) const override;
  void gradient(ConstVec x, Vec& g) const override;
  /// Block-diagonal majorant of the positive part of the Hessian: pairs come and go, the pattern stays.
  void gauss_newton_hessian(ConstVec x, SparseMatrix& H) const override;

 private:
  struct Pair {
    int i, j;
  };
  std::vector<Pair> close_pairs(ConstVec x) const;

  double threshold_;
  std::vector<std::vector<int>> near_on_surface_;  // sorted, of every vertex
};

}  // namespace softform
