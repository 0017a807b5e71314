#pragma once

// What figures 5.5 and 5.6 report of a character that is posed by pins: the metrics of tables 5.1 and 5.2, and the
// tables that plot_pins.py draws.

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "softform/characters/pin_characters.hpp"
#include "softform/experiment/run.hpp"

namespace softform {

inline PipelineObserver progress_of(Run& run)
{
  return [&run, stage = 0](const PipelineProgress& progress) mutable {
    if (progress.stage != stage) run.step(fmt::format("stage {}", stage = progress.stage));
    run.progress(progress.text);
    return true;
  };
}

/// All stages, with wall and processor time.
inline std::vector<PinStage> run_stages(Run& run, const PinCharacter& character)
{
  const double start = Run::cpu_s();
  std::vector<PinStage> stages =
      run_pin_pipeline(character.body, character.drawn.targets, character.options, progress_of(run));
  double tracing = 0;
  for (const PinStage& stage : stages) tracing += stage.trace_seconds;
  run.metric("cpu", Run::cpu_s() - start - tracing, "s");
  return stages;
}

/// Largest distance of a density from 0 or 1.
inline double greyness(const Vec& densities)
{
  return densities.cwiseMin((1 - densities.array()).matrix()).cwiseAbs().maxCoeff();
}

inline void report_traces(Run& run, const PinCharacter& character, const PinStage& stage, const std::string& suffix)
{
  for (std::size_t i = 0; i < stage.traces.size(); ++i) {
    const PoseTrace& trace = stage.traces[i];
    const std::string pose = character.drawn.names[i] + suffix;
    double smallest = trace.steps.front().relative_eigenvalue;
    // NaN, the mark of an unstable state, must not be lost.
    for (const TraceStep& step : trace.steps)
      if (!(step.relative_eigenvalue >= smallest)) smallest = step.relative_eigenvalue;
    run.metric("reached_" + pose, trace.is_reached ? 1 : 0, "1");
    run.metric("smallest_eigenvalue_" + pose, smallest, "1");
    run.metric("trace_difference_" + pose, (trace.x - stage.positions[i]).lpNorm<Eigen::Infinity>(), "m");
  }
}

inline void report_stage(Run& run, const PinCharacter& character, const PinStage& stage, const std::string& suffix)
{
  const auto metric = [&](const std::string& name, double value, const char* unit) {
    run.metric(fmt::format("{}_{}{}", name, stage.number, suffix), value, unit);
  };
  for (std::size_t i = 0; i < stage.errors.size(); ++i) {
    metric("max_error_" + character.drawn.names[i], stage.errors[i].max, "m");
    metric("mean_error_" + character.drawn.names[i], stage.errors[i].mean, "m");
  }
  metric("mean_error", stage.mean_error(), "m");
  metric("is_sound", stage.is_sound() ? 1 : 0, "1");
  metric("failed_equilibria", stage.failed_equilibria, "1");
  metric("time", stage.seconds, "s");
}

/// The three stages of a character, one after the other.
inline void report_stages(Run& run, const PinCharacter& character, const std::vector<PinStage>& stages)
{
  double seconds = 0, largest_ratio = 0;
  for (std::size_t s = 0; s < stages.size(); ++s) {
    report_stage(run, character, stages[s], "");
    seconds += stages[s].seconds;
    if (s > 0) largest_ratio = std::max(largest_ratio, stages[s].mean_error() / stages[s - 1].mean_error());
  }
  const PinStage& last = stages.back();
  run.metric("elements", character.body.element_count(), "1");
  run.metric("actuators", last.pins.count(), "1");
  run.metric("improvement", stages.front().mean_error() / last.mean_error(), "1");
  run.metric("largest_ratio_of_stages", largest_ratio, "1");
  run.metric("grey", greyness(last.densities), "1");
  run.metric("stiff_fraction", last.densities.mean(), "1");
  run.metric("time_stages", seconds, "s");
  report_traces(run, character, last, "");
}

/// The third stage again, from another first density.
inline void report_second_start(Run& run, PinCharacter& character, const std::vector<PinStage>& stages, double density)
{
  run.step(fmt::format("stage 3 from density {:g}", density));
  character.options.first_density = density;
  const PinStage second =
      continue_pin_pipeline(stages.at(1), character.body, character.drawn.targets, character.options, progress_of(run))
          .back();
  report_stage(run, character, second, "_second");
  run.metric("grey_second", greyness(second.densities), "1");
  run.metric("second_over_first", second.mean_error() / stages.back().mean_error(), "1");
}

/// Triangles with their densities; every pose's target and stages, and its pins.
inline void write_figure(Run& run, const PinCharacter& character, const std::vector<PinStage>& stages)
{
  const auto rounded = [](double x) { return 1e-7 * std::round(1e7 * x); };  // a tenth of a micrometre
  CsvTable& triangles = run.series("triangles", {{"a"}, {"b"}, {"c"}, {"density"}});
  for (int e = 0; e < character.body.element_count(); ++e) {
    const auto t = character.body.elements().row(e);
    triangles.add_row({double(t[0]), double(t[1]), double(t[2]), stages.back().densities[e]});
  }
  const auto write_points = [&](const std::string& name, const Vec& x) {
    CsvTable& points = run.series(name, {{"x", "m"}, {"y", "m"}});
    for (Eigen::Index i = 0; i < x.size(); i += 2) points.add_row({rounded(x[i]), rounded(x[i + 1])});
  };
  write_points("rest", character.body.rest_positions());
  for (std::size_t i = 0; i < character.drawn.names.size(); ++i) {
    const std::string& pose = character.drawn.names[i];
    write_points(pose + "_target", character.drawn.targets[i]);
    for (const PinStage& stage : stages) {
      write_points(fmt::format("{}_{}", pose, stage.number), stage.positions[i]);
      CsvTable& pins = run.series(fmt::format("{}_{}_pins", pose, stage.number), {{"x", "m"}, {"y", "m"}});
      for (const Pin<2>& pin : pins_of_pose(character.body, stage.pins, i, 1)) {
        const Point<2> at = position<2>(pin.point, stage.positions[i]);
        pins.add_row({rounded(at.x()), rounded(at.y())});
      }
    }
  }
  CsvTable& places = run.series("places", {{"x", "m"}, {"y", "m"}});
  for (const Point<2>& place : stages.back().pins.places) places.add_row({rounded(place.x()), rounded(place.y())});
}

}  // namespace softform
