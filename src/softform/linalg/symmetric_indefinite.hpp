#pragma once

#include <memory>

#include "softform/core/types.hpp"

namespace softform {

/// Direct factorisation A = L D L^t of symmetric indefinite sparse matrices with 1x1 and 2x2 pivots (MUMPS, METIS
/// ordering): for KKT systems, where factorisations without pivoting give wrong inertia and large residuals. The
/// symbolic analysis is made at the first call and kept until the pattern changes. Only the lower triangle is read.
class SymmetricIndefinite {
 public:
  SymmetricIndefinite();
  ~SymmetricIndefinite();
  SymmetricIndefinite(SymmetricIndefinite&&) noexcept;
  SymmetricIndefinite& operator=(SymmetricIndefinite&&) noexcept;

  /// A is square, compressed and sorted. Returns false when it is numerically singular or not finite; throws
  /// std::runtime_error when memory runs out.
  bool factorize(const SparseMatrix& A);

  /// After a successful factorisation: the number of negative eigenvalues of A, by Sylvester's law of inertia.
  int negative_eigenvalues() const;

  /// Solves with the last successful factorisation and refines the result until the componentwise backward error is at
  /// round-off or ceases to fall (Arioli, Demmel and Duff 1989).
  Vec solve(ConstVec b) const;

  /// Entries of the factor L.
  double factor_nonzeros() const;

 private:
  struct Mumps;
  std::unique_ptr<Mumps> mumps_;
};

}  // namespace softform
