#include "softform/fem/block_pattern.hpp"

#include <algorithm>

namespace softform {
namespace {

// Where the local block (local_row, local_column) of an element goes.
struct Entry {
  int column, row, element, local_row, local_column;
};

std::vector<Entry> entries_of(const Elements& row_elements, const Elements& column_elements)
{
  const int corners = static_cast<int>(row_elements.cols());
  std::vector<Entry> entries;
  entries.reserve(static_cast<std::size_t>(row_elements.size() * corners));
  for (int e = 0; e < row_elements.rows(); ++e)
    for (int r = 0; r < corners; ++r)
      for (int c = 0; c < corners; ++c) entries.push_back({column_elements(e, c), row_elements(e, r), e, r, c});
  std::stable_sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
    return a.column != b.column ? a.column < b.column : a.row < b.row;
  });
  return entries;
}

}  // namespace

template <int rows, int columns>
VertexBlockPattern<rows, columns>::VertexBlockPattern(const Elements& row_elements, int row_vertices,
                                                      const Elements& column_elements, int column_vertices)
    : corners_(static_cast<int>(row_elements.cols()))
{
  const auto entries = entries_of(row_elements, column_elements);
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
void VertexBlockPattern<rows, columns>::prepare(SparseMatrix& matrix) const
{
  if (matrix.rows() != zero_.rows() || matrix.cols() != zero_.cols() || matrix.nonZeros() != zero_.nonZeros())
    matrix = zero_;
}

template <int rows, int columns>
void VertexBlockPattern<rows, columns>::assemble(const std::vector<Block>& blocks, SparseMatrix& matrix) const
{
  prepare(matrix);
  const auto block_of = [&](int element, int r, int c) -> const Block& {
    return blocks[static_cast<std::size_t>(corners_ * (corners_ * element + c) + r)];
  };
  for_each_block(block_of, matrix, [](auto place, const Column& column) { place = column; });
}

template <int size>
void assemble_vertex_vector(const Elements& elements, const std::vector<double>& element_vectors, Vec& g)
{
  g.setZero();
  const double* entries = element_vectors.data();
  for (int e = 0; e < elements.rows(); ++e)
    for (int k = 0; k < elements.cols(); ++k, entries += size)
      g.segment<size>(size * elements(e, k)) += Eigen::Map<const Eigen::Matrix<double, size, 1>>(entries);
}

void assemble_vector(const Elements& elements, const std::vector<double>& element_vectors, Vec& g)
{
  assemble_vertex_vector<3>(elements, element_vectors, g);
}

template class VertexBlockPattern<2>;
template class VertexBlockPattern<3>;
template class VertexBlockPattern<3, 2>;
template void assemble_vertex_vector<2>(const Elements&, const std::vector<double>&, Vec&);
template void assemble_vertex_vector<3>(const Elements&, const std::vector<double>&, Vec&);

}  // namespace softform
