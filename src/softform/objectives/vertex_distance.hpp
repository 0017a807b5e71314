#pragma once

#include "softform/core/types.hpp"
#include "softform/objectives/objective.hpp"

namespace softform {

/// Mean squared distance between corresponding vertices after the best rigid alignment,
///     E = sum_i w_i |x_i - (R t_i + s)|^2 / size^2,   sum_i w_i = 1,
/// w_i the vertex areas of the target. It complements (4.12), which lets small local errors add up over the model.
/// At the best alignment the derivatives of R and s drop out of the gradient.
class AlignedVertexDistance : public Objective {
 public:
  /// target_positions: (3n) [m].
  AlignedVertexDistance(const Triangles& triangles, ConstVec target_positions);

  double value(ConstVec x) const override;
  void gradient(ConstVec x, Vec& g) const override;
  void gauss_newton_hessian(ConstVec x, SparseMatrix& H) const override;

 private:
  Positions aligned_target(ConstVec x) const;

  Positions target_;
  Vec weights_;  // (n), divided by size^2
};

}  // namespace softform
