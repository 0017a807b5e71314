#pragma once

#include "softform/core/types.hpp"

namespace softform {

/// target += scale * source for entries on the pattern of `target`, which must hold those of `source`; rows above the
/// diagonal are left out where the target stores its lower triangle only. `row` and `column` are where the source's
/// first entry goes.
void add_scaled(const SparseMatrix& source, double scale, SparseMatrix& target, int row = 0, int column = 0);

/// A weighted sum of sparse matrices placed as blocks of a larger one. The pattern is the union of all that was ever
/// added, so that after the first round only values are rewritten.
class SparseSum {
 public:
  explicit SparseSum(int size) : SparseSum(size, size) {}
  SparseSum(int rows, int columns) : sum_(rows, columns) {}
  void clear() { sum_.coeffs().setZero(); }
  void add(const SparseMatrix& term, double weight, int row, int column);
  const SparseMatrix& matrix() const { return sum_; }

 private:
  SparseMatrix sum_;
};

}  // namespace softform
