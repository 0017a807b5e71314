#include "softform/characters/string_pipeline.hpp"

#include <fmt/format.h>

#include "softform/core/error.hpp"
#include "softform/core/interrupt.hpp"
#include "softform/core/stopwatch.hpp"

namespace softform {
namespace {

class StringPipeline {
 public:
  StringPipeline(const PlanarSolid& body, const PosedMesh<2>& character, const StringPipelineOptions& options,
                 const PipelineObserver& observer)
      : body_(body),
        character_(character),
        options_(options),
        report_(observer),
        field_(body),
        densities_(Vec::Zero(body.element_count())),
        posed_{body, densities_, character.held, character.targets}
  {
    // What is held cannot be elsewhere: only the errors are measured against the targets as they are.
    const Vec& free = character.held.free;
    for (Vec& target : posed_.targets)
      target = free.cwiseProduct(target) + (1 - free.array()).matrix().cwiseProduct(body.rest_positions());
  }

  std::vector<StringStage> run()
  {
    std::vector<StringStage> stages;
    for (int number = 1; number <= options_.last_stage && !report_.is_stopped(); ++number) {
      StringStage stage;
      {
        const Stopwatch watch(stage.seconds);
        if (number == 1)
          select(stage);
        else
          place(stages.back(), stage);
      }
      stage.number = number;
      finish(stage);
      stages.push_back(std::move(stage));
    }
    return stages;
  }

 private:
  void select(StringStage& stage);
  void place(const StringStage& before, StringStage& stage);
  void finish(StringStage& stage);
  LoadedSolid<2> loaded(const StringStage& stage, std::size_t pose, double fraction) const;

  const PlanarSolid& body_;
  const PosedMesh<2>& character_;
  const StringPipelineOptions& options_;
  PipelineWatch report_;
  BoundaryField field_;
  Vec densities_;
  PosedBody posed_;
};

void StringPipeline::select(StringStage& stage)
{
  std::vector<Vec> positions = character_.targets;
  positions.push_back(body_.rest_positions());
  StringSelection selection =
      select_strings(posed_, ring_around(positions, options_.ring_margin), options_.strings, options_.selection,
                     [this](const std::string& text) { return report_(1, text); });
  stage.strings = std::move(selection.strings);
  stage.positions = std::move(selection.poses.positions);
  stage.failed_equilibria = selection.poses.failed_equilibria;
}

void StringPipeline::place(const StringStage& before, StringStage& stage)
{
  StringPlacement placement =
      place_strings(posed_, before.strings, before.positions, options_.placement, [this](const Iterate& iterate) {
        return report_(2, fmt::format("step {}: 1/2 sum of squares {:.4g} mm^2", iterate.k, iterate.objective));
      });
  stage.strings = std::move(placement.strings);
  stage.positions = std::move(placement.poses.positions);
  stage.failed_equilibria = placement.failed_equilibria;
}

LoadedSolid<2> StringPipeline::loaded(const StringStage& stage, std::size_t pose, double fraction) const
{
  std::vector<String<2>> strings = strings_of_pose(field_, stage.strings, pose);
  for (String<2>& string : strings) string.tension *= fraction;
  return LoadedSolid<2>(body_, densities_, {}, {}, std::move(strings));
}

void StringPipeline::finish(StringStage& stage)
{
  stage.densities = densities_;
  stage.plan = string_plan(field_, stage.strings, stage.positions);
  stage.report.termination = report_.is_stopped() || interrupted() ? Termination::Interrupted : Termination::Converged;
  measure_stage<2>(stage, character_.targets, character_.held,
                   [&](std::size_t pose) { return loaded(stage, pose, 1); });
  if (report_.is_stopped() || stage.number < options_.last_stage) return;
  const Stopwatch watch(stage.trace_seconds);
  for (std::size_t i = 0; i < stage.positions.size(); ++i) {
    if (!report_(stage.number, fmt::format("tracing '{}' from rest", character_.names[i]))) return;
    stage.traces.push_back(trace_pose<2>(LoadPath<2>([&, i](double fraction) { return loaded(stage, i, fraction); }),
                                         character_.held, [this](double) { return body_.rest_positions(); }));
  }
}

}  // namespace

std::vector<StringStage> run_string_pipeline(const PlanarSolid& body, const PosedMesh<2>& character,
                                             const StringPipelineOptions& options, const PipelineObserver& observer)
{
  require_upright<2>(character, "the poses");
  if (character.held.free.size() == 0 || character.held.free.minCoeff() > 0)
    throw InputError("nothing is held: strings only pull, so that a part of the body must stay in its place");
  if (options.last_stage < 1 || options.last_stage > 2)
    throw InputError(fmt::format("there is no last stage {} for strings: it is 1 or 2", options.last_stage));
  return StringPipeline(body, character, options, observer).run();
}

}  // namespace softform
