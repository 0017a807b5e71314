#include "softform/fem/block_pattern.hpp"

#include <algorithm>
#include <array>

namespace softform {
namespace {

struct Entry {
  int column, row, element, local_row, local_column;
};

std::vector<Entry> entries_of(const Triangles& triangles)
{
  std::vector<Entry> entries;
  entries.reserve(static_cast<std::size_t>(triangles.rows()) * 9);
  for (int t = 0; t < triangles.rows(); ++t)
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) entries.push_back({triangles(t, c), triangles(t, r), t, r, c});
  std::stable_sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
    return a.column != b.column ? a.column < b.column : a.row < b.row;
  });
  return entries;
}

}  // namespace

BlockPattern::BlockPattern(const Triangles& triangles, int vertex_count)
{
  const auto entries = entries_of(triangles);
  std::vector<std::vector<int>> rows(static_cast<std::size_t>(vertex_count));
  for (std::size_t k = 0; k < entries.size(); ++k) {
    const Entry& e = entries[k];
    auto& column_rows = rows[static_cast<std::size_t>(e.column)];
    if (column_rows.empty() || column_rows.back() != e.row) {
      block_column_.push_back(e.column);
      block_rank_.push_back(static_cast<int>(column_rows.size()));
      contribution_start_.push_back(static_cast<int>(k));
      column_rows.push_back(e.row);
    }
    contributions_.push_back({e.element, e.local_row, e.local_column});
  }
  contribution_start_.push_back(static_cast<int>(entries.size()));

  zero_.resize(3 * vertex_count, 3 * vertex_count);
  zero_.reserve(static_cast<Eigen::Index>(block_column_.size() * 9));
  for (int j = 0; j < vertex_count; ++j) {
    for (int q = 0; q < 3; ++q) {
      zero_.startVec(3 * j + q);
      for (int i : rows[static_cast<std::size_t>(j)])
        for (int p = 0; p < 3; ++p) zero_.insertBack(3 * i + p, 3 * j + q) = 0;
    }
  }
  zero_.finalize();
}

void BlockPattern::prepare(SparseMatrix& matrix) const
{
  if (matrix.rows() != zero_.rows() || matrix.nonZeros() != zero_.nonZeros()) matrix = zero_;
}

void BlockPattern::assemble(const std::vector<Eigen::Matrix3d>& blocks, SparseMatrix& matrix) const
{
  prepare(matrix);
  const auto block_of = [&](int triangle, int r, int c) -> const Eigen::Matrix3d& {
    return blocks[static_cast<std::size_t>(9 * triangle + 3 * c + r)];
  };
  for_each_block(block_of, matrix, [](auto place, const Vec3& column) { place = column; });
}

void assemble_vector(const Triangles& triangles, const std::vector<double>& elements, Vec& g)
{
  g.setZero();
  for (int t = 0; t < triangles.rows(); ++t)
    for (int k = 0; k < 3; ++k)
      g.segment<3>(3 * triangles(t, k)) += Eigen::Map<const Vec3>(&elements[static_cast<std::size_t>(9 * t + 3 * k)]);
}

}  // namespace softform
