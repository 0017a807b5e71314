#pragma once

#include "softform/core/types.hpp"
#include "softform/fem/enclosed_volume.hpp"
#include "softform/objectives/objective.hpp"

namespace softform {

/// V_reference / V(x): prefers convex rest shapes (thesis 4.4.2), since any region bounded by a plane curve can be
/// mirrored without a change of the inflated shape. Positive, so that
/// an objective that has it as a term can be judged by its relative decrease.
class VolumeReward : public Objective {
 public:
  VolumeReward(const Triangles& triangles, ConstVec reference_positions)
      : volume_(triangles, static_cast<int>(reference_positions.size() / 3)),
        reference_volume_(volume_.value(reference_positions))
  {}

  double value(ConstVec x) const override { return reference_volume_ / volume_.value(x); }
  void gradient(ConstVec x, Vec& g) const override
  {
    volume_.gradient(x, g);
    const double volume = volume_.value(x);
    g *= -reference_volume_ / (volume * volume);
  }
  /// Zero: the volume is an indefinite function of positions, of which only the slope is wanted.
  void gauss_newton_hessian(ConstVec x, SparseMatrix& H) const override { H.resize(x.size(), x.size()); }

 private:
  EnclosedVolume volume_;
  double reference_volume_;
};

}  // namespace softform
