#pragma once

#include <optional>
#include <string>
#include <vector>

#include "softform/characters/character_task.hpp"
#include "softform/characters/strings.hpp"
#include "softform/io/csv.hpp"

namespace softform {

/// What a task led to: its stages, and what the character is held by after the last of them.
template <int dim>
struct CharacterDesign {
  std::vector<CharacterStage<dim>> stages;
  std::vector<std::string> names;   ///< of the stages
  std::vector<Pins> pins;           ///< a stage each, when held by pins
  std::vector<StringPlan> strings;  ///< a stage each, when pulled by strings

  int actuators(const CharacterTask& task, std::size_t stage) const;

  /// The stage that is to be made: the last one that ended as it should with every element soft or stiff, or else the
  /// last one, whose elements are then rounded to the nearer material.
  std::size_t made_stage() const;
};

/// Runs the stages of a task whose body has this dimension. Throws InputError as the pipelines do.
template <int dim>
CharacterDesign<dim> design_character(const CharacterTask& task, const PipelineObserver& observer = {});

/// All numbers of a design by name: `max_error_<stage>_<pose>` and so on, and without stage and pose those of the end.
template <int dim>
std::vector<Metric> design_metrics(const CharacterTask& task, const CharacterDesign<dim>& design);

/// The same as a table, one line a stage and pose.
template <int dim>
std::string pose_table(const CharacterTask& task, const CharacterDesign<dim>& design);

/// What a person has to know: how each stage ended, poses that are not reached from rest, equilibria that failed.
template <int dim>
std::string design_report(const CharacterTask& task, const CharacterDesign<dim>& design);

/// Writes rest.vtu, target_<pose>.vtu and <stage>_<pose>.vtu with the distance of every vertex to its target and the
/// density of every element.
template <int dim>
void write_stages(const std::filesystem::path& folder, const CharacterTask& task, const CharacterDesign<dim>& design);

}  // namespace softform
