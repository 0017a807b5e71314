#pragma once

#include <string>
#include <variant>
#include <vector>

#include "softform/characters/clamp_pipeline.hpp"
#include "softform/characters/drill_plan.hpp"
#include "softform/characters/pin_pipeline.hpp"
#include "softform/characters/posed_mesh.hpp"
#include "softform/characters/printed_body.hpp"

namespace softform {

enum class ActuatorKind { Pins, Strings, Clamps };

/// What a character is made of; without a stiff material it is of the soft one alone.
struct CharacterMaterials {
  double soft_shear_modulus = 0, stiff_shear_modulus = 0;  ///< [Pa]; 0 where there is none
  double soft_density = 0, stiff_density = 0;              ///< [kg/m^3]
  double poisson_ratio = 0.4;                              ///< of solids; sheets are incompressible
};

/// A design task as a user describes it.
struct CharacterTask {
  std::string source;  ///< the file
  std::variant<PosedMesh<2>, PosedMesh<3>> body;
  CharacterMaterials materials;
  Vec3 gravity = Vec3::Zero();  ///< [m/s^2]
  ActuatorKind kind = ActuatorKind::Pins;
  ActuatorRange range{0, 0};  ///< of pins and strings
  std::vector<int> vertices;  ///< where pins are wanted; empty leaves that to the first stage
  std::vector<Clamp> clamps;  ///< moved when they are the actuators, else held at rest (in the body's `held`)
  double ring_margin = 1.2;   ///< of the strings' ring, times the largest distance of a vertex from its centre
  std::vector<std::string> stages;
  MaterialLayoutOptions layout;
  PinPlacementWeights placement;
  double first_density = 0.5;
  PrintOptions print;
  DrillOptions drill;

  bool is_planar() const { return body.index() == 0; }
  /// 1 actuators, 2 places, 3 materials.
  int last_stage() const;
};

/// The stages' names in their order: "actuators" (their number), "places", "materials". Strings have no "materials";
/// clamps begin with "uniform", the body of one density in the clamps.
std::vector<std::string> stage_names(ActuatorKind kind);

/// The body of a task with its materials, thickness and weight. The task's body must have this dimension.
template <int dim>
Solid<dim> make_solid(const CharacterTask& task);

}  // namespace softform
