#pragma once

#include "softform/core/types.hpp"

namespace softform {

/// A dimensionless function of vertex positions (3n) [m]: a distance to a target or a regulariser.
class Objective {
 public:
  virtual ~Objective() = default;

  virtual double value(ConstVec x) const = 0;
  /// (3n) [1/m].
  virtual void gradient(ConstVec x, Vec& g) const = 0;
  /// A positive semi-definite model of the Hessian (3n, 3n) [1/m^2], both triangles stored, the same pattern at every
  /// call: Gauss-Newton where the objective is a sum of squares.
  virtual void gauss_newton_hessian(ConstVec x, SparseMatrix& H) const = 0;
  /// The exact Hessian, on a pattern that stays. Returns false, and leaves H alone, where there is none.
  virtual bool hessian(ConstVec, SparseMatrix&) const { return false; }
};

}  // namespace softform
