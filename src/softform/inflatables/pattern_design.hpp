#pragma once

#include <memory>

#include "softform/inflatables/inflatable.hpp"
#include "softform/inflatables/pattern_objectives.hpp"
#include "softform/inverse/full_space_program.hpp"

namespace softform {

/// What a pattern is made of and how it is inflated.
struct InflationSettings {
  std::shared_ptr<const Material> material;
  /// What an optimisation begins with, or none: a material with the same behaviour in the large, but gentler in small
  /// changes. Its optimum is a start for that of the material, as along the central path of an interior point method.
  std::shared_ptr<const Material> first_material = nullptr;
  double thickness = 0;  ///< [m]
  double pressure = 0;   ///< [Pa]
  NewtonOptions newton = inflation_options();
};

/// What pattern optimisation minimises.
struct PatternObjectiveSettings {
  PatternWeights weights;
  InteriorLaplacian laplacian = InteriorLaplacian::MeanValue;
  double unit_length = 1;  ///< the target's size [m]
  /// Designs with a triangle below this quality are refused: where a step folds a panel, no mesh of it is good again.
  /// With 0 those are that turn one over.
  double least_quality = 0;
};

/// The programme (6.16) for a mesh that stays: find flat panels X (2v) and inflated nodes x (3n), z = (x, X), that
/// minimise the objectives, with a StabilityBarrier, subject to the balance of forces (6.15), in units of the pressure
/// on a node. For any optimiser; restore() inflates the panels again. Steps are measured by how much they stretch the
/// panels' edges. x0 (3n) [m] is a state near equilibrium of the layout's flat panels.
std::unique_ptr<FullSpaceProgram> pattern_program(const PanelLayout& layout, const Vec& x0,
                                                  const InflationSettings& inflation,
                                                  std::shared_ptr<const ImlsField> target,
                                                  const PatternObjectiveSettings& objectives);

}  // namespace softform
