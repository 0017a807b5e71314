#include "softform/characters/pin_pipeline.hpp"

#include <algorithm>

#include <Eigen/LU>
#include <fmt/format.h>

#include "softform/core/error.hpp"
#include "softform/core/stopwatch.hpp"

namespace softform {
namespace {

// x with its held coordinates at rest.
Vec held_at_rest(const PlanarSolid& body, const FixedDofs& held, const Vec& x)
{
  if (held.free.size() == 0) return x;
  return held.free.cwiseProduct(x) + (1 - held.free.array()).matrix().cwiseProduct(body.rest_positions());
}

void validate(const PlanarSolid& body, const std::vector<Vec>& targets, const PinPipelineOptions& options)
{
  if (targets.empty()) throw InputError("a character needs a pose to be designed for: give one");
  for (std::size_t i = 0; i < targets.size(); ++i) require_target<2>(body, targets[i], i);
  if (options.last_stage < 1 || options.last_stage > 3)
    throw InputError(fmt::format("there is no stage {}: the last one is 1, 2 or 3", options.last_stage));
  if (options.last_stage == 3 && body.mixture().contrast() == 1)
    throw InputError("the third stage lays out two materials, and the body has one: give it two, or end at stage 2");
  const std::vector<int> boundary = boundary_vertices<2>(body.elements());
  for (const int vertex : options.vertices) {
    if (std::find(boundary.begin(), boundary.end(), vertex) == boundary.end())
      throw InputError(fmt::format("actuator at vertex {}: pins sit on the boundary, choose a vertex there", vertex));
    if (options.held.free.size() > 0 && options.held.free.segment<2>(2 * Eigen::Index(vertex)).minCoeff() == 0)
      throw InputError(
          fmt::format("actuator at vertex {}, which is held: a pin cannot move what a clamp holds", vertex));
  }
}

class PinPipeline {
 public:
  PinPipeline(const PlanarSolid& body, const std::vector<Vec>& targets, const PinPipelineOptions& options,
              const PipelineObserver& observer)
      : body_(body), targets_(targets), options_(options), report_(observer), sparse_(options.sparse)
  {
    // What is held cannot be elsewhere: only the errors are measured against the targets as they are.
    for (const Vec& target : targets) held_targets_.push_back(held_at_rest(body, options.held, target));
    sparse_.held = options.held;
  }

  // The stages after `before`, or all of them.
  std::vector<PinStage> run(const PinStage* before)
  {
    std::vector<PinStage> stages;
    if (before) before_ = *before;
    bool goes_on = true;
    for (int number = before_.number + 1; number <= options_.last_stage && goes_on; ++number) {
      PinStage stage = timed_stage(number);
      if (report_.is_stopped()) stage.report.termination = Termination::Interrupted;
      goes_on = stage.report.converged();
      measure(stage);
      stages.push_back(stage);
      before_ = std::move(stage);
    }
    return stages;
  }

 private:
  PinStage timed_stage(int number)
  {
    double seconds = 0;
    PinStage stage;
    {
      const Stopwatch watch(seconds);
      stage = number == 1 ? sparse_stage() : number == 2 ? placement_stage() : material_stage();
    }
    stage.number = number;
    stage.seconds = seconds;
    return stage;
  }

  PinStage sparse_stage();
  PinStage placement_stage();
  PinStage material_stage();
  PinPlacement placed(const Pins& pins, const std::vector<Vec>& positions, int rounds);
  PinStage stage_from(PinPlacement placement) const;
  void measure(PinStage& stage) const;
  PoseTrace trace(const PinStage& stage, std::size_t pose) const;
  std::vector<Pin<2>> springs(const Pins& pins, std::size_t pose) const
  {
    return pins_of_pose(body_, pins, pose, options_.placement.weights.stiffness);
  }

  const PlanarSolid& body_;
  const std::vector<Vec>& targets_;
  const PinPipelineOptions& options_;
  PipelineWatch report_;
  SparseActuationOptions sparse_;
  std::vector<Vec> held_targets_;
  PinStage before_;
};

PinPlacement PinPipeline::placed(const Pins& pins, const std::vector<Vec>& positions, int rounds)
{
  PinPlacementOptions options = options_.placement;
  options.held = options_.held;
  options.rounds = rounds;
  return place_pins(
      body_, Vec::Zero(body_.element_count()), held_targets_, pins, positions, options, [this](const Iterate& iterate) {
        return report_(2, fmt::format("step {}: 1/2 sum of squares {:.4g} mm^2", iterate.k, iterate.objective));
      });
}

PinStage PinPipeline::stage_from(PinPlacement placement) const
{
  PinStage stage;
  stage.densities = Vec::Zero(body_.element_count());
  stage.positions = std::move(placement.positions);
  stage.pins = std::move(placement.pins);
  stage.failed_equilibria = placement.failed_equilibria;
  if (placement.is_settled)
    stage.report.termination = Termination::Converged;
  else
    stage.report = {Termination::Infeasible, "a pose has no equilibrium under its pins", {}, {}, {}};
  return stage;
}

PinStage PinPipeline::sparse_stage()
{
  PointActuation actuation;
  if (options_.vertices.empty()) {
    actuation = actuation_in_range(body_, held_targets_, options_.actuators, sparse_,
                                   [this](const std::string& text) { return report_(1, text); });
  } else {
    actuation.positions = held_targets_;
    actuation = refitted(body_, held_targets_, options_.vertices, actuation, sparse_);
  }
  return stage_from(placed(pins_from(body_, actuation, options_.placement.weights), actuation.positions, 0));
}

PinStage PinPipeline::placement_stage()
{
  return stage_from(placed(before_.pins, before_.positions, options_.placement.rounds));
}

PinStage PinPipeline::material_stage()
{
  PinStage stage = before_;
  stage.traces.clear();
  std::vector<MaterialPose<2>> poses;
  for (std::size_t i = 0; i < targets_.size(); ++i)
    poses.push_back({held_targets_[i], stage.positions[i], options_.held, {}, springs(stage.pins, i), {}, true});
  MaterialDesign<2> design(body_, std::move(poses), options_.limits);
  const auto first = design.start(Vec::Constant(body_.element_count(), options_.first_density));
  if (!first) {
    stage.report = {
        Termination::Infeasible, "no equilibrium at uniform densities: try another first density", {}, {}, {}};
    return stage;
  }
  MaterialLayout<2> layout =
      optimize_layout<2>(design, *first, options_.layout,
                         [this](const LayoutProgress& progress) { return report_(3, describe(progress)); });
  stage.densities = std::move(layout.state.rho);
  stage.positions = std::move(layout.state.x);
  for (std::size_t i = 0; i < targets_.size(); ++i)
    for (int j = 0; j < stage.pins.count(); ++j)
      stage.pins.positions[i][static_cast<std::size_t>(j)] = layout.state.pins[i].segment<2>(2 * j);
  stage.failed_equilibria = layout.refused_moves;
  stage.report = std::move(layout.report);
  return stage;
}

// Fills in what a stage is judged by.
void PinPipeline::measure(PinStage& stage) const
{
  measure_stage<2>(stage, targets_, options_.held, [&](std::size_t pose) {
    return LoadedSolid<2>(body_, stage.densities, {}, springs(stage.pins, pose));
  });
  if (stage.number < options_.first_traced_stage) return;
  const Stopwatch watch(stage.trace_seconds);
  for (std::size_t i = 0; i < targets_.size(); ++i) stage.traces.push_back(trace(stage, i));
}

// From rest, the pins led along the way and to where they are held in the end.
PoseTrace PinPipeline::trace(const PinStage& stage, std::size_t pose) const
{
  const Vec& rest = body_.rest_positions();
  const auto way = [&](double t) {
    return options_.way ? options_.way(pose, t) : Vec((1 - t) * rest + t * targets_[pose]);
  };
  const std::vector<Pin<2>> ends = springs(stage.pins, pose);
  const Vec end = way(1);
  const auto loads = [&](double t) {
    const Vec x = way(t);
    std::vector<Pin<2>> pins = ends;
    for (Pin<2>& pin : pins)
      pin.position = position<2>(pin.point, x) + t * (pin.position - position<2>(pin.point, end));
    return LoadedSolid<2>(body_, stage.densities, {}, std::move(pins));
  };
  return trace_pose<2>(LoadPath<2>(loads), options_.held, [&](double) { return rest; });
}

}  // namespace

std::vector<PinStage> run_pin_pipeline(const PlanarSolid& body, const std::vector<Vec>& targets,
                                       const PinPipelineOptions& options, const PipelineObserver& observer)
{
  validate(body, targets, options);
  return PinPipeline(body, targets, options, observer).run(nullptr);
}

std::vector<PinStage> continue_pin_pipeline(const PinStage& before, const PlanarSolid& body,
                                            const std::vector<Vec>& targets, const PinPipelineOptions& options,
                                            const PipelineObserver& observer)
{
  validate(body, targets, options);
  return PinPipeline(body, targets, options, observer).run(&before);
}

}  // namespace softform
