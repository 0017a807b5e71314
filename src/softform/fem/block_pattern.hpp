#pragma once

#include <vector>

#include "softform/core/types.hpp"

namespace softform {

/// The sparsity pattern of a matrix of 3 x 3 vertex blocks coupling the vertices of each triangle: computed once, then
/// only values are rewritten. The matrix is stored in full (both triangles), compressed by columns.
class BlockPattern {
 public:
  BlockPattern() = default;
  /// The pattern of a mesh's one-rings: block (i, j) exists where i = j or i and j share a triangle.
  BlockPattern(const Triangles& triangles, int vertex_count);

  /// A zero matrix (3n, 3n) with this pattern.
  const SparseMatrix& zero() const { return zero_; }

  /// Gives `matrix` this pattern if it has another; its values are then unspecified.
  void prepare(SparseMatrix& matrix) const;

  /// Sums element matrices into `matrix` in parallel and in a fixed order, so that the result does not depend on the
  /// number of threads. `elements` holds (9, 9) matrices, column-major, one after the other; rows and columns are the
  /// coordinates of the triangle's three vertices.
  void assemble(const std::vector<double>& elements, SparseMatrix& matrix) const;

 private:
  struct Contribution {
    int element, row, column;  // local vertex numbers
  };
  SparseMatrix zero_;
  std::vector<int> contribution_start_;  // of every block
  std::vector<Contribution> contributions_;
  std::vector<int> block_column_;  // vertex j of every block
  std::vector<int> block_rank_;    // place of the block in its column
};

/// Sums element vectors (9 each) into `g` (3n), in the order of the triangles.
void assemble_vector(const Triangles& triangles, const std::vector<double>& elements, Vec& g);

}  // namespace softform
