#pragma once

#include <vector>

#include "softform/characters/character_stage.hpp"
#include "softform/characters/posed_mesh.hpp"
#include "softform/characters/string_selection.hpp"

namespace softform {

struct StringPipelineOptions {
  int strings = 4;           ///< how many
  double ring_margin = 1.2;  ///< see ring_around()
  int last_stage = 2;        ///< 1 or 2
  StringSelectionOptions selection;
  StringPlacementOptions placement;
};

/// A stage of a planar character that is posed by strings.
struct StringStage : CharacterStage<2> {
  StringLayout strings;
  StringPlan plan;
};

/// The first two stages of chapter 5 for a planar character that is posed by strings over a ring: selection (5.4.2) and
/// placement (5.4.3) on the soft body. What the character holds stays at rest and must keep it from moving as a rigid
/// body: strings only pull. The last stage is traced from rest, all strings drawn together. Returns the stages that
/// were run, in order; an interrupted one is the last. Throws InputError for poses that do not fit, nothing held, fewer
/// places than strings wanted, and stages that are not there.
std::vector<StringStage> run_string_pipeline(const PlanarSolid& body, const PosedMesh<2>& character,
                                             const StringPipelineOptions& options = {},
                                             const PipelineObserver& observer = {});

}  // namespace softform
