#pragma once

#include <memory>

#include "softform/core/types.hpp"

namespace softform {

/// Direct factorisation of symmetric sparse matrices of one fixed pattern (CHOLMOD, METIS ordering). The symbolic
/// analysis is made at the first call and kept until the pattern changes. Only the lower triangle is read. Matrices are
/// compressed and finite: CHOLMOD lets NaN pass.
class SparseFactorization {
 public:
  SparseFactorization();
  ~SparseFactorization();
  SparseFactorization(SparseFactorization&&) noexcept;
  SparseFactorization& operator=(SparseFactorization&&) noexcept;

  /// Supernodal A = L L^T. Returns false when A is not positive definite: the cheapest test of it.
  bool cholesky(const SparseMatrix& A);

  /// Simplicial A = L D L^T without pivoting, for matrices that are close to definite (a few negative eigenvalues).
  /// Returns false on a zero pivot.
  bool indefinite(const SparseMatrix& A);

  /// After a successful factorisation: the number of negative eigenvalues of A, by Sylvester's law of inertia.
  int negative_eigenvalues() const { return negative_eigenvalues_; }

  /// Solves with the last successful factorisation.
  Vec solve(ConstVec b) const;

  /// Factorisations tried so far, failed ones too: what a solver costs.
  int attempts() const { return attempts_; }

  /// Number of nonzeros of the factor L.
  double factor_nonzeros() const;

 private:
  struct Cholmod;
  std::unique_ptr<Cholmod> cholmod_;
  int negative_eigenvalues_ = 0;
  int attempts_ = 0;
};

}  // namespace softform
