#include "softform/linalg/sparse_sum.hpp"

#include <vector>

#include "softform/core/parallel.hpp"

namespace softform {
namespace {

bool contains(const SparseMatrix& target, const SparseMatrix& source, int row, int column)
{
  for (int j = 0; j < source.outerSize(); ++j) {
    int place = target.outerIndexPtr()[j + column];
    const int end = target.outerIndexPtr()[j + column + 1];
    for (SparseMatrix::InnerIterator entry(source, j); entry; ++entry) {
      while (place < end && target.innerIndexPtr()[place] < entry.row() + row) ++place;
      if (place == end || target.innerIndexPtr()[place] != entry.row() + row) return false;
    }
  }
  return true;
}

}  // namespace

void add_scaled(const SparseMatrix& source, double scale, SparseMatrix& target, int row, int column)
{
  const int columns = static_cast<int>(source.outerSize());
  parallel_for(columns, [&](int j) {
    int place = target.outerIndexPtr()[j + column];
    const int end = target.outerIndexPtr()[j + column + 1];
    for (SparseMatrix::InnerIterator entry(source, j); entry; ++entry) {
      const int i = static_cast<int>(entry.row()) + row;
      while (place < end && target.innerIndexPtr()[place] < i) ++place;
      if (place < end && target.innerIndexPtr()[place] == i) target.valuePtr()[place] += scale * entry.value();
    }
  });
}

void SparseSum::add(const SparseMatrix& term, double weight, int row, int column)
{
  if (!contains(sum_, term, row, column)) {
    std::vector<Eigen::Triplet<double>> entries;
    entries.reserve(static_cast<std::size_t>(sum_.nonZeros() + term.nonZeros()));
    for (int j = 0; j < sum_.outerSize(); ++j)
      for (SparseMatrix::InnerIterator entry(sum_, j); entry; ++entry)
        entries.emplace_back(static_cast<int>(entry.row()), j, entry.value());
    for (int j = 0; j < term.outerSize(); ++j)
      for (SparseMatrix::InnerIterator entry(term, j); entry; ++entry)
        entries.emplace_back(static_cast<int>(entry.row()) + row, j + column, 0.0);
    sum_.setFromTriplets(entries.begin(), entries.end());
  }
  add_scaled(term, weight, sum_, row, column);
}

}  // namespace softform
