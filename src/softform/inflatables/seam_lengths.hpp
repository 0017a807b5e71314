#pragma once

#include <array>
#include <vector>

#include "softform/inflatables/panel_layout.hpp"
#include "softform/objectives/objective.hpp"

namespace softform {

/// Equal lengths of what is sewn together (6.19): for every seam edge the squared difference of its lengths in the flat
/// panels, of each further side against the first,
///     E(X) = 1/L^2 sum_e (l_0(e) - l_k(e))^2.
/// A function of flat positions (2v) [m].
class SeamLengths : public Objective {
 public:
  SeamLengths(const PanelLayout& layout, double unit_length);

  double value(ConstVec flat) const override;
  void gradient(ConstVec flat, Vec& g) const override;
  void gauss_newton_hessian(ConstVec flat, SparseMatrix& H) const override { assemble(flat, false, H); }
  bool hessian(ConstVec flat, SparseMatrix& H) const override
  {
    assemble(flat, true, H);
    return true;
  }

 private:
  /// The two flat edges of a pair as vertices: first (start, end), second (start, end).
  using Pair = std::array<int, 4>;
  void assemble(ConstVec flat, bool is_exact, SparseMatrix& H) const;

  std::vector<Pair> pairs_;
  double scale_;  // 1/L^2
};

}  // namespace softform
