#include "softform/fem/block_pattern.hpp"

#include <algorithm>
#include <array>

namespace softform {
namespace {

struct Entry {
  int column, row, element, local_row, local_column;
};

std::vector<Entry> entries_of(const Triangles& row_triangles, const Triangles& column_triangles)
{
  std::vector<Entry> entries;
  entries.reserve(static_cast<std::size_t>(row_triangles.rows()) * 9);
  for (int t = 0; t < row_triangles.rows(); ++t)
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) entries.push_back({column_triangles(t, c), row_triangles(t, r), t, r, c});
  std::stable_sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
    return a.column != b.column ? a.column < b.column : a.row < b.row;
  });
  return entries;
}

}  // namespace

template <int rows, int columns>
BlockPatternOf<rows, columns>::BlockPatternOf(const Triangles& row_triangles, int row_vertices,
                                              const Triangles& column_triangles, int column_vertices)
{
  const auto entries = entries_of(row_triangles, column_triangles);
  std::vector<std::vector<int>> rows_of(static_cast<std::size_t>(column_vertices));
  for (std::size_t k = 0; k < entries.size(); ++k) {
    const Entry& e = entries[k];
    auto& column_rows = rows_of[static_cast<std::size_t>(e.column)];
    if (column_rows.empty() || column_rows.back() != e.row) {
      block_column_.push_back(e.column);
      block_rank_.push_back(static_cast<int>(column_rows.size()));
      contribution_start_.push_back(static_cast<int>(k));
      column_rows.push_back(e.row);
    }
    contributions_.push_back({e.element, e.local_row, e.local_column});
  }
  contribution_start_.push_back(static_cast<int>(entries.size()));

  zero_.resize(rows * row_vertices, columns * column_vertices);
  zero_.reserve(static_cast<Eigen::Index>(block_column_.size() * rows * columns));
  for (int j = 0; j < column_vertices; ++j) {
    for (int q = 0; q < columns; ++q) {
      zero_.startVec(columns * j + q);
      for (int i : rows_of[static_cast<std::size_t>(j)])
        for (int p = 0; p < rows; ++p) zero_.insertBack(rows * i + p, columns * j + q) = 0;
    }
  }
  zero_.finalize();
}

template <int rows, int columns>
void BlockPatternOf<rows, columns>::prepare(SparseMatrix& matrix) const
{
  if (matrix.rows() != zero_.rows() || matrix.cols() != zero_.cols() || matrix.nonZeros() != zero_.nonZeros())
    matrix = zero_;
}

template <int rows, int columns>
void BlockPatternOf<rows, columns>::assemble(const std::vector<Block>& blocks, SparseMatrix& matrix) const
{
  prepare(matrix);
  const auto block_of = [&](int triangle, int r, int c) -> const Block& {
    return blocks[static_cast<std::size_t>(9 * triangle + 3 * c + r)];
  };
  for_each_block(block_of, matrix, [](auto place, const auto& column) { place = column; });
}

template class BlockPatternOf<3, 3>;
template class BlockPatternOf<3, 2>;
template class BlockPatternOf<2, 2>;

void assemble_vector(const Triangles& triangles, const std::vector<double>& elements, Vec& g)
{
  g.setZero();
  for (int t = 0; t < triangles.rows(); ++t)
    for (int k = 0; k < 3; ++k)
      g.segment<3>(3 * triangles(t, k)) += Eigen::Map<const Vec3>(&elements[static_cast<std::size_t>(9 * t + 3 * k)]);
}

}  // namespace softform
