#pragma once

#include "softform/characters/string_candidates.hpp"

namespace softform {

/// The squared errors [mm^2] of all poses as quadratic functions of the candidates' tensions tau [N], about given
/// poses,
///     1/2 |x - t|^2 + w/2 |tau|^2 = constant + q . tau + 1/2 tau . M tau,   x = x_0 + K^-1 (F tau - dW/dx(x_0)),
/// F the nodal forces of unit tensions: the best tensions of any few of them are a small non-negative quadratic
/// programme.
class TensionModel {
 public:
  struct Pose {
    double constant;
    Vec q;
    Eigen::MatrixXd M;
  };

  /// About the targets themselves, without strings. tension_weight: w [mm^2/N^2].
  TensionModel(const PosedBody& posed, const StringCandidates& candidates, double tension_weight);

  const std::vector<Pose>& poses() const { return poses_; }
  /// By pose, of the candidates chosen.
  std::vector<Vec> best_tensions(const std::vector<int>& chosen) const;
  /// What remains with them, all poses together.
  double least_error(const std::vector<int>& chosen) const;

 private:
  std::vector<Pose> poses_;
};

}  // namespace softform
