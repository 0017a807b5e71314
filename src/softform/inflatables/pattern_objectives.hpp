#pragma once

#include <memory>
#include <vector>

#include "softform/inflatables/panel_layout.hpp"
#include "softform/objectives/imls_field.hpp"
#include "softform/objectives/weighted_sum.hpp"

namespace softform {

/// Weights of the objectives of pattern optimisation (6.16), all of them sums over nodes, edges or vertices of squares
/// of lengths in units of the target's size.
struct PatternWeights {
  double distance = 1;  ///< (6.17)
  double seams = 1;     ///< (6.18), times the seams' own weights
  /// (6.19): panels are sewn edge to edge, so that this is to hold nearly exactly.
  double length = 300;
  /// (6.20): as large as the distance, it would hold seams straight that had better bend.
  double boundary = 0.1;
  /// (6.21): interior vertices spread as the boundary does. Weaker, triangles grow where the target is missed.
  double interior = 10;
  /// Of a barrier for every node against shapes that give way (StabilityBarrier), from a stiffness of 1 on, in units of
  /// the pressure per unit length: the softest motion of a bear, an ear that tilts, has 1.5 before and .75 after.
  double stability = 2e-6;
};

/// What interior vertices of a flat panel are compared with in (6.21).
enum class InteriorLaplacian {
  Tutte,      ///< the mean of their neighbours, as in the thesis: it pulls irregular meshes together
  MeanValue,  ///< the weighted mean that they are now (Floater 2003): zero to begin with
};

/// Areas of the flat triangles (m) [m^2].
Vec flat_areas(const PanelLayout& layout);

/// The terms E_k(x) of the nodes (3n): (6.17) over the skins and (6.18). The layout's flat panels weigh the surface,
/// its nodes on seams are where the seams should be.
std::vector<WeightedObjective> state_objectives(const PanelLayout& layout, std::shared_ptr<const ImlsField> target,
                                                double unit_length, const PatternWeights& weights);

/// The terms R_l(X) of the flat positions (2v): (6.19), (6.20) and (6.21).
std::vector<WeightedObjective> design_objectives(const PanelLayout& layout, double unit_length,
                                                 const PatternWeights& weights, InteriorLaplacian laplacian);

}  // namespace softform
