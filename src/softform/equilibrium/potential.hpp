#pragma once

#include "softform/core/types.hpp"

namespace softform {

/// A potential energy of positions x alone; its stationary points are the static equilibria (3.14).
class Potential {
 public:
  virtual ~Potential() = default;

  /// [J]; +infinity or NaN where x is inadmissible.
  virtual double value(ConstVec x) const = 0;
  /// The negative of the total nodal forces [N].
  virtual void gradient(ConstVec x, Vec& g) const = 0;
  /// The true Hessian [N/m], both triangles stored, always on the same pattern.
  virtual void hessian(ConstVec x, SparseMatrix& K) const = 0;
  /// A positive semi-definite model of the Hessian on the same pattern, for states where the true one is indefinite.
  /// Returns false, and leaves K alone, when there is none.
  virtual bool projected_hessian(ConstVec, SparseMatrix&) const { return false; }

  /// Coordinates of a vertex: 3 in space, 2 in the plane.
  virtual int dimension() const { return 3; }
  /// The force [N] that stands for a fully unbalanced vertex: residuals are relative to it.
  virtual double force_scale() const = 0;
  /// A length [m] that stands for the size of the object: step caps are relative to it.
  virtual double length_scale() const = 0;
};

/// Which coordinates may move: 1 is free, 0 is held. Empty means that all are free.
struct FixedDofs {
  Vec free;

  void project(Vec& g) const
  {
    if (free.size() > 0) g.array() *= free.array();
  }
  /// Zeroes the rows and columns of held coordinates, with `diagonal` on their diagonal.
  void project(SparseMatrix& K, double diagonal) const;
};

}  // namespace softform
