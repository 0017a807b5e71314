#pragma once

#include <vector>

#include "softform/core/parallel.hpp"
#include "softform/core/types.hpp"

namespace softform {

/// Vertex indices of elements, one row each: triangles, tetrahedra, ...
using Elements = Eigen::Ref<const Eigen::Matrix<int, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>;

/// The sparsity pattern of a matrix of vertex blocks (rows, columns), 2 in the plane and 3 in space, coupling the
/// vertices of each element: computed once, then only values are rewritten. The matrix is stored in full (both
/// triangles), compressed by columns. An element may have other vertices in the rows than in the columns: those of the
/// deformed and of the rest shape.
template <int rows, int columns = rows>
class VertexBlockPattern {
 public:
  using Block = Eigen::Matrix<double, rows, columns>;
  using Column = Eigen::Matrix<double, rows, 1>;

  VertexBlockPattern() = default;
  /// The pattern of a mesh's one-rings: block (i, j) exists where i = j or i and j share an element.
  VertexBlockPattern(const Elements& elements, int vertex_count)
      : VertexBlockPattern(elements, vertex_count, elements, vertex_count)
  {}
  /// Block (i, j) exists where i is a vertex of an element in the rows and j one of the same element in the columns.
  VertexBlockPattern(const Elements& row_elements, int row_vertices, const Elements& column_elements,
                     int column_vertices);

  /// A zero matrix (rows n, columns m) with this pattern.
  const SparseMatrix& zero() const { return zero_; }

  /// Gives `matrix` this pattern if it has another; its values are then unspecified.
  void prepare(SparseMatrix& matrix) const;

  /// Sums element matrices into `matrix` in parallel and in a fixed order, so that the result does not depend on the
  /// number of threads. With k corners an element, blocks[k^2 e + k c + r] couples the local vertices r (row) and c
  /// (column) of element e.
  void assemble(const std::vector<Block>& blocks, SparseMatrix& matrix) const;

  /// Adds block_of(element, r, c), the block that couples the element's local vertices r and c, for every element to a
  /// matrix that has this pattern.
  template <class BlockOf>
  void add(const BlockOf& block_of, SparseMatrix& matrix) const
  {
    for_each_block(block_of, matrix, [](auto place, const Column& column) { place += column; });
  }

 private:
  // write(place, column) for the columns of every sum of block_of.
  template <class BlockOf, class Write>
  void for_each_block(const BlockOf& block_of, SparseMatrix& matrix, const Write& write) const;

  struct Contribution {
    int element, row, column;  // local vertex numbers
  };
  int corners_ = 0;
  SparseMatrix zero_;
  std::vector<int> contribution_start_;  // of every block
  std::vector<Contribution> contributions_;
  std::vector<int> block_column_;  // vertex j of every block
  std::vector<int> block_rank_;    // place of the block in its column
};

using BlockPattern = VertexBlockPattern<3>;

template <int rows, int columns>
template <class BlockOf, class Write>
void VertexBlockPattern<rows, columns>::for_each_block(const BlockOf& block_of, SparseMatrix& matrix,
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
      write(Eigen::Map<Column>(values + column_start[columns * block_column_[index] + q] + rows * block_rank_[index]),
            block.col(q));
  });
}

/// Sums element vectors (3 entries a corner) into `g` (3n), in the order of the elements.
void assemble_vector(const Elements& elements, const std::vector<double>& element_vectors, Vec& g);
/// The same with `size` entries a corner and vertex.
template <int size>
void assemble_vertex_vector(const Elements& elements, const std::vector<double>& element_vectors, Vec& g);

}  // namespace softform
