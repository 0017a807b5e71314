#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "softform/characters/character_design.hpp"

namespace softform {

/// What was written for making a character.
struct Fabrication {
  PrintedBody print;
  DrillPlan drill;                 ///< of characters held by pins or strings; no poses otherwise
  std::vector<std::string> notes;  ///< what the maker has to know, a line each
};

/// Lengths between body and ring and tensions of all strings, pose by pose, and by how much each has to be drawn in
/// (negative) or let out from rest and from the pose before: pose, string, tension [N], length [mm], from_rest [mm],
/// from_previous [mm].
std::string string_table(const StringPlan& plan, const std::vector<std::string>& poses);

/// From shape to print, for the stage that is to be made: the surfaces of both materials, islands.csv, and for pins a
/// plate for every pose (drill_<pose>.svg), one for the pins' places in the body at rest (drill_rest.svg) and
/// drill.csv; for strings the same with the ring's pulleys (drill_ring.svg), and strings.csv.
template <int dim>
Fabrication fabricate(const std::filesystem::path& folder, const CharacterTask& task,
                      const CharacterDesign<dim>& design);

}  // namespace softform
