#include "softform/linalg/sparse_sum.hpp"

#include <vector>

#include "softform/core/parallel.hpp"

namespace softform {
namespace {

bool contains(const SparseMatrix& target, const SparseMatrix& source, int offset)
{
  for (int j = 0; j < source.outerSize(); ++j) {
    int place = target.outerIndexPtr()[j + offset];
    const int end = target.outerIndexPtr()[j + offset + 1];
    for (SparseMatrix::InnerIterator entry(source, j); entry; ++entry) {
      while (place < end && target.innerIndexPtr()[place] < entry.row() + offset) ++place;
      if (place == end || target.innerIndexPtr()[place] != entry.row() + offset) return false;
    }
  }
  return true;
}

}  // namespace

void add_scaled(const SparseMatrix& source, double scale, SparseMatrix& target, int offset)
{
  const int columns = static_cast<int>(source.outerSize());
  parallel_for(columns, [&](int j) {
    int place = target.outerIndexPtr()[j + offset];
    const int end = target.outerIndexPtr()[j + offset + 1];
    for (SparseMatrix::InnerIterator entry(source, j); entry; ++entry) {
      const int row = static_cast<int>(entry.row()) + offset;
      while (place < end && target.innerIndexPtr()[place] < row) ++place;
      if (place < end && target.innerIndexPtr()[place] == row) target.valuePtr()[place] += scale * entry.value();
    }
  });
}

void SparseSum::add(const SparseMatrix& term, double weight, int offset)
{
  if (!contains(sum_, term, offset)) {
    std::vector<Eigen::Triplet<double>> entries;
    entries.reserve(static_cast<std::size_t>(sum_.nonZeros() + term.nonZeros()));
    for (int j = 0; j < sum_.outerSize(); ++j)
      for (SparseMatrix::InnerIterator entry(sum_, j); entry; ++entry)
        entries.emplace_back(static_cast<int>(entry.row()), j, entry.value());
    for (int j = 0; j < term.outerSize(); ++j)
      for (SparseMatrix::InnerIterator entry(term, j); entry; ++entry)
        entries.emplace_back(static_cast<int>(entry.row()) + offset, j + offset, 0.0);
    sum_.setFromTriplets(entries.begin(), entries.end());
  }
  add_scaled(term, weight, sum_, offset);
}

}  // namespace softform
