#pragma once

#include <vector>

#include "softform/characters/character_stage.hpp"
#include "softform/characters/drawing.hpp"
#include "softform/characters/material_layout.hpp"
#include "softform/characters/pin_placement.hpp"
#include "softform/characters/sparse_actuation.hpp"

namespace softform {

struct PinPipelineOptions {
  /// How many actuators the first stage has to find. Not used where `vertices` names them.
  ActuatorRange actuators{4, 6};
  /// Boundary vertices chosen by the user as actuators: the first stage only finds their forces.
  std::vector<int> vertices;
  /// Coordinates that stay where they are at rest in every pose, such as those of a foot in its stand.
  FixedDofs held;
  int last_stage = 3;
  /// Density of the uniform body that the third stage starts from.
  double first_density = 0.5;
  SparseActuationOptions sparse;
  PinPlacementOptions placement;
  EquilibriumLimits limits;
  MaterialLayoutOptions layout;
  /// Every pose of the stages from this one on is traced from rest, along `way` (straight lines when it is empty).
  int first_traced_stage = 3;
  PoseWay way;
};

/// A stage of a planar character that is posed by pins.
struct PinStage : CharacterStage<2> {
  Pins pins;  ///< after the first stage at vertices, then on the boundary
};

/// The pipeline of chapter 5 for a planar character posed by pins: sparse actuation of the soft body (5.4.2), places
/// (5.4.3) and, where the body's mixture has two materials, their layout with the pins' positions free and their places
/// kept (5.5). targets: (2n) [m] each. Returns the stages that were run, in order; one that is interrupted or fails is
/// the last. Throws InputError naming what cannot be used: targets of another mesh or with elements turned over, a
/// range that cannot be met, vertices off the boundary or held, stages that are not there.
std::vector<PinStage> run_pin_pipeline(const PlanarSolid& body, const std::vector<Vec>& targets,
                                       const PinPipelineOptions& options = {}, const PipelineObserver& observer = {});

/// The stages that come after one that was run before, with other options for example.
std::vector<PinStage> continue_pin_pipeline(const PinStage& before, const PlanarSolid& body,
                                            const std::vector<Vec>& targets, const PinPipelineOptions& options = {},
                                            const PipelineObserver& observer = {});

}  // namespace softform
