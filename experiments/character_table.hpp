#pragma once

// The characters of tables 5.1 and 5.2: every one that exists, run through its whole pipeline with the options of its
// figure.

#include <string>
#include <vector>

#include "pin_figures.hpp"
#include "softform/characters/bar_character.hpp"
#include "softform/core/stopwatch.hpp"

namespace softform {

/// A row of table 5.1.
struct StageErrors {
  int stage;
  std::vector<PoseError> poses;
};

struct TableCharacter {
  std::string name;
  std::vector<StageErrors> rows;
  int elements = 0, actuators = 0;
  int failed_equilibria = 0;
  bool is_sound = true;  ///< all poses of all stages are stable equilibria
  double greyness = 0;
  double seconds = 0, cpu_s = 0;  ///< of all stages
};

inline TableCharacter run_pinned_character(Run& run, const std::string& name, int triangles, int last_stage)
{
  run.step(name);
  PinCharacter character = make_pin_character(name, triangles);
  character.options.last_stage = last_stage;
  character.options.first_traced_stage = 4;  // the figures trace the poses
  TableCharacter result{name, {}, character.body.element_count()};
  const double start = Run::cpu_s();
  for (const PinStage& stage :
       run_pin_pipeline(character.body, character.drawn.targets, character.options, progress_of(run))) {
    result.rows.push_back({stage.number, stage.errors});
    result.actuators = stage.pins.count();
    result.failed_equilibria += stage.failed_equilibria;
    result.is_sound = result.is_sound && stage.is_sound() && stage.report.converged();
    result.greyness = greyness(stage.densities);
    result.seconds += stage.seconds;
  }
  result.cpu_s = Run::cpu_s() - start;
  return result;
}

/// The bar of figure 5.8: uniform, which is what the thesis calls the second stage, and of two materials.
inline TableCharacter run_question_mark(Run& run)
{
  run.step("question_mark");
  BarOptions options;
  if (!run.is_paper()) options.cells = {24, 4, 1};
  const BarCharacter bar(options, question_marks().front().bends);
  const Vec target = bar.pose(1);
  TableCharacter result{"question_mark", {}, bar.body().element_count(), 2};
  const double start = Run::cpu_s();
  {
    const Stopwatch watch(result.seconds);
    const PoseTrace uniform = bar.trace(Vec::Constant(bar.body().element_count(), options.first_density));
    const MaterialLayout<3> layout = bar.optimize(uniform.x, [&](const LayoutProgress& progress) {
      run.progress(describe(progress));
      return true;
    });
    result.rows = {{2, {pose_error<3>(uniform.x, target)}}, {3, {pose_error<3>(layout.state.x.at(0), target)}}};
    result.failed_equilibria = layout.refused_moves;
    result.is_sound = uniform.is_reached && layout.report.converged();
    result.greyness = greyness(layout.state.rho);
  }
  result.cpu_s = Run::cpu_s() - start;
  return result;
}

/// All characters in the order of table 5.2. The quick run is of those that take seconds.
inline std::vector<TableCharacter> run_characters(Run& run)
{
  std::vector<TableCharacter> characters;
  if (run.is_paper()) {
    characters.push_back(run_pinned_character(run, "tour_eiffel", 525, 2));
    characters.push_back(run_pinned_character(run, "palmy_2d", 2745, 3));
  }
  characters.push_back(run_pinned_character(run, "worm_eye", run.by_size(300, 808), 3));
  characters.push_back(run_question_mark(run));
  return characters;
}

}  // namespace softform
