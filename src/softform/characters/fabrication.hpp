#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "softform/characters/character_design.hpp"

namespace softform {

/// What was written for making a character.
struct Fabrication {
  PrintedBody print;
  DrillPlan drill;                ///< of characters held by pins; no poses otherwise
  std::vector<std::string> notes;  ///< what the maker has to know, a line each
};

/// From shape to print, for the stage that is to be made: the surfaces of both materials, islands.csv, and for pins a
/// plate for every pose (drill_<pose>.svg), one for the pins' places in the body at rest (drill_rest.svg) and drill.csv.
template <int dim>
Fabrication fabricate(const std::filesystem::path& folder, const CharacterTask& task,
                      const CharacterDesign<dim>& design);

}  // namespace softform
