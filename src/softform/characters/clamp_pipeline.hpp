#pragma once

#include <string>
#include <vector>

#include "softform/characters/character_stage.hpp"
#include "softform/characters/material_layout.hpp"
#include "softform/characters/posed_mesh.hpp"

namespace softform {

/// A part of a body that is moved rigidly, by hand or by a bracket: position and orientation (5.5).
struct Clamp {
  std::string name;
  std::vector<int> vertices;  ///< three that are not on a line, at least
};

/// The clamps' coordinates, and those that the body's own hold holds.
template <int dim>
FixedDofs held_by(const PosedMesh<dim>& character, const std::vector<Clamp>& clamps);

/// Positions (dim n) in which the vertices of every clamp have moved rigidly, as closely as they can to where the way
/// to the pose has them, and those held stay at rest; the others are where the way has them.
template <int dim>
Vec clamped_positions(const PosedMesh<dim>& character, const std::vector<Clamp>& clamps, std::size_t pose,
                      double fraction);

struct ClampPipelineOptions {
  /// 2 ends with the uniform body posed, 3 with two materials.
  int last_stage = 3;
  /// Density of the uniform body.
  double first_density = 0.5;
  EquilibriumLimits limits;
  MaterialLayoutOptions layout;
};

/// The pipeline of chapter 5 for a body that is posed by clamps: their number and places are given, so it begins with
/// the uniform body led into the poses ("stage 2"), and goes on with the layout of two materials (5.5). Every stage is
/// traced from rest. Returns the stages that were run, in order; an interrupted one is the last.
/// Throws InputError for clamps that overlap, hold too little, or leave nothing free, and for poses that do not fit.
template <int dim>
std::vector<CharacterStage<dim>> run_clamp_pipeline(const Solid<dim>& body, const PosedMesh<dim>& character,
                                                    const std::vector<Clamp>& clamps,
                                                    const ClampPipelineOptions& options = {},
                                                    const PipelineObserver& observer = {});

}  // namespace softform
