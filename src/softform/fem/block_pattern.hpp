#pragma once

#include <vector>

#include "softform/core/parallel.hpp"
#include "softform/core/types.hpp"

namespace softform {

/// The sparsity pattern of a matrix of vertex blocks coupling the vertices of each triangle: computed once, then only
/// values are rewritten. The matrix is stored in full (both triangles), compressed by columns. A triangle may have
/// other vertices in the rows than in the columns: those of the deformed and of the rest shape.
template <int rows, int columns>
class BlockPatternOf {
 public:
  using Block = Eigen::Matrix<double, rows, columns>;

  BlockPatternOf() = default;
  /// The pattern of a mesh's one-rings: block (i, j) exists where i = j or i and j share a triangle.
  BlockPatternOf(const Triangles& triangles, int vertex_count)
      : BlockPatternOf(triangles, vertex_count, triangles, vertex_count)
  {}
  /// Block (i, j) exists where i is a vertex of a triangle in the rows and j one of the same triangle in the columns.
  BlockPatternOf(const Triangles& row_triangles, int row_vertices, const Triangles& column_triangles,
                 int column_vertices);

  /// A zero matrix (rows n, columns m) with this pattern.
  const SparseMatrix& zero() const { return zero_; }

  /// Gives `matrix` this pattern if it has another; its values are then unspecified.
  void prepare(SparseMatrix& matrix) const;

  /// Sums element matrices into `matrix` in parallel and in a fixed order, so that the result does not depend on the
  /// number of threads. blocks[9 t + 3 c + r] couples the local vertices r (row) and c (column) of triangle t.
  void assemble(const std::vector<Block>& blocks, SparseMatrix& matrix) const;

  /// Adds block_of(triangle, r, c), the block that couples the triangle's local vertices r and c, for every
  /// triangle to a matrix that has this pattern.
  template <class BlockOf>
  void add(const BlockOf& block_of, SparseMatrix& matrix) const
  {
    for_each_block(block_of, matrix, [](auto place, const auto& column) { place += column; });
  }

 private:
  // write(place, column) for the columns of every sum of block_of.
  template <class BlockOf, class Write>
  void for_each_block(const BlockOf& block_of, SparseMatrix& matrix, const Write& write) const;

  struct Contribution {
    int element, row, column;  // local vertex numbers
  };
  SparseMatrix zero_;
  std::vector<int> contribution_start_;  // of every block
  std::vector<Contribution> contributions_;
  std::vector<int> block_column_;  // vertex j of every block
  std::vector<int> block_rank_;    // place of the block in its column
};

/// Square matrices of vertices in space.
using BlockPattern = BlockPatternOf<3, 3>;

template <int rows, int columns>
template <class BlockOf, class Write>
void BlockPatternOf<rows, columns>::for_each_block(const BlockOf& block_of, SparseMatrix& matrix,
                                                   const Write& write) const
{
  double* values = matrix.valuePtr();
  const int* column_start = matrix.outerIndexPtr();
  const int block_count = static_cast<int>(block_column_.size());
  parallel_for(block_count, [&](int b) {
    Block block = Block::Zero();
    const auto index = static_cast<std::size_t>(b);
    for (int k = contribution_start_[index]; k < contribution_start_[index + 1]; ++k) {
      const Contribution& c = contributions_[static_cast<std::size_t>(k)];
      block += block_of(c.element, c.row, c.column);
    }
    for (int q = 0; q < columns; ++q)
      write(Eigen::Map<Eigen::Matrix<double, rows, 1>>(values + column_start[columns * block_column_[index] + q] +
                                                       rows * block_rank_[index]),
            block.col(q));
  });
}

/// Sums element vectors (9 each) into `g` (3n), in the order of the triangles.
void assemble_vector(const Triangles& triangles, const std::vector<double>& elements, Vec& g);

}  // namespace softform
