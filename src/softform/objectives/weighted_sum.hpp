#pragma once

#include <memory>
#include <vector>

#include "softform/linalg/sparse_sum.hpp"
#include "softform/objectives/objective.hpp"

namespace softform {

/// One weighted term of a design objective.
struct WeightedObjective {
  double weight;
  std::shared_ptr<const Objective> objective;
};

/// sum_k w_k E_k(x).
double weighted_value(const std::vector<WeightedObjective>& terms, ConstVec x);
Vec weighted_gradient(const std::vector<WeightedObjective>& terms, ConstVec x);

/// The Hessians of weighted terms, each kept with its pattern between calls.
class TermHessians {
 public:
  /// The terms outlive this object.
  explicit TermHessians(const std::vector<WeightedObjective>& terms) : terms_(terms), hessians_(terms.size()) {}

  /// Adds the Gauss-Newton Hessians to the diagonal block of `sum` that starts at `offset`.
  void add_gauss_newton(SparseSum& sum, ConstVec x, int offset);
  /// The same with the exact Hessians. Returns false where a term has none.
  bool add_exact(SparseSum& sum, ConstVec x, int offset);

 private:
  const std::vector<WeightedObjective>& terms_;
  std::vector<SparseMatrix> hessians_;
};

}  // namespace softform
