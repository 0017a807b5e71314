#pragma once

#include <vector>

#include "softform/core/types.hpp"

namespace softform {

/// The matrix A = H + mu J^t J + alpha D + shift I on one pattern that is computed once; only its lower triangle is
/// stored.
class NormalMatrix {
 public:
  /// Recomputes the values; the pattern is built at the first call. The arguments keep their patterns between calls.
  const SparseMatrix& assemble(const SparseMatrix& H, const SparseMatrix& J, double mu, const SparseMatrix& D,
                               double alpha);
  /// The same with another damping, H, J and mu as in the last call to assemble.
  const SparseMatrix& with_damping(const SparseMatrix& D, double alpha, double shift = 0);

 private:
  void build_pattern(const SparseMatrix& H, const SparseMatrix& J, const SparseMatrix& D);
  void transpose_values(const SparseMatrix& J);
  void add_squared_jacobian(const SparseMatrix& J, double mu);

  SparseMatrix undamped_, A_, transpose_;
  std::vector<int> transpose_slots_;  // where each value of J goes in the transpose
};

}  // namespace softform
