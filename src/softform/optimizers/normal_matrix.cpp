#include "softform/optimizers/normal_matrix.hpp"

#include <algorithm>

#include "softform/core/parallel.hpp"
#include "softform/linalg/sparse_sum.hpp"

namespace softform {

void NormalMatrix::build_pattern(const SparseMatrix& H, const SparseMatrix& J, const SparseMatrix& D)
{
  const auto ones = [](SparseMatrix matrix) {
    matrix.coeffs().setOnes();
    return matrix;
  };
  const SparseMatrix J1 = ones(J);
  SparseMatrix identity(J.cols(), J.cols());
  identity.setIdentity();
  const SparseMatrix JtJ = J1.transpose() * J1;
  const SparseMatrix full = JtJ + ones(H) + ones(D) + identity;
  undamped_ = full.triangularView<Eigen::Lower>();
  undamped_.makeCompressed();
  A_ = undamped_;

  transpose_ = J.transpose();
  transpose_.makeCompressed();
  std::vector<int> next(transpose_.outerIndexPtr(), transpose_.outerIndexPtr() + transpose_.outerSize());
  transpose_slots_.resize(static_cast<std::size_t>(J.nonZeros()));
  for (Eigen::Index k = 0; k < J.nonZeros(); ++k)
    transpose_slots_[static_cast<std::size_t>(k)] = next[static_cast<std::size_t>(J.innerIndexPtr()[k])]++;
}

void NormalMatrix::transpose_values(const SparseMatrix& J)
{
  const int count = static_cast<int>(J.nonZeros());
  parallel_for(count,
               [&](int k) { transpose_.valuePtr()[transpose_slots_[static_cast<std::size_t>(k)]] = J.valuePtr()[k]; });
}

// Gustavson's algorithm on the lower triangle: column j of J^t J is the sum of J_kj times row k of J.
void NormalMatrix::add_squared_jacobian(const SparseMatrix& J, double mu)
{
  transpose_values(J);
  const int columns = static_cast<int>(J.cols());
  parallel_ranges(columns, [&](int first, int last) {
    Vec sum = Vec::Zero(columns);
    for (int j = first; j < last; ++j) {
      for (SparseMatrix::InnerIterator entry(J, j); entry; ++entry) {
        const int* begin = transpose_.innerIndexPtr() + transpose_.outerIndexPtr()[entry.row()];
        const int* end = transpose_.innerIndexPtr() + transpose_.outerIndexPtr()[entry.row() + 1];
        const double* values = transpose_.valuePtr();
        for (const int* i = std::lower_bound(begin, end, j); i != end; ++i)
          sum[*i] += entry.value() * values[i - transpose_.innerIndexPtr()];
      }
      for (SparseMatrix::InnerIterator entry(undamped_, j); entry; ++entry) {
        entry.valueRef() += mu * sum[entry.row()];
        sum[entry.row()] = 0;
      }
    }
  });
}

const SparseMatrix& NormalMatrix::assemble(const SparseMatrix& H, const SparseMatrix& J, double mu,
                                           const SparseMatrix& D, double alpha)
{
  if (undamped_.rows() != J.cols()) build_pattern(H, J, D);
  undamped_.coeffs().setZero();
  add_scaled(H, 1, undamped_);
  add_squared_jacobian(J, mu);
  return with_damping(D, alpha);
}

const SparseMatrix& NormalMatrix::with_damping(const SparseMatrix& D, double alpha, double shift)
{
  A_.coeffs() = undamped_.coeffs();
  add_scaled(D, alpha, A_);
  // Rigid motions of state and design leave everything unchanged: a shift at round-off level holds them.
  shift += 1e-13 * A_.diagonal().cwiseAbs().mean();
  for (int j = 0; j < A_.outerSize(); ++j) A_.valuePtr()[A_.outerIndexPtr()[j]] += shift;
  return A_;
}

}  // namespace softform
