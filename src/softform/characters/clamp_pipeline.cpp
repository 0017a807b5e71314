#include "softform/characters/clamp_pipeline.hpp"

#include <algorithm>
#include <map>

#include <Eigen/SVD>
#include <fmt/format.h>

#include "softform/core/error.hpp"
#include "softform/core/stopwatch.hpp"
#include "softform/mesh/alignment.hpp"

namespace softform {
namespace {

template <int dim>
Positions places_of(const Vec& x, const std::vector<int>& vertices)
{
  Positions places = Positions::Zero(std::ssize(vertices), 3);
  for (std::size_t k = 0; k < vertices.size(); ++k)
    places.row(Eigen::Index(k)).template head<dim>() = x.template segment<dim>(dim * vertices[k]);
  return places;
}

template <int dim>
void validate(const PosedMesh<dim>& character, const std::vector<Clamp>& clamps, const ClampPipelineOptions& options)
{
  if (clamps.empty()) throw InputError("nothing is clamped: name a region at least");
  if (options.last_stage < 2 || options.last_stage > 3)
    throw InputError(fmt::format("there is no last stage {}: clamps know 2 and 3", options.last_stage));
  require_upright<dim>(character, "the poses");
  std::map<int, std::string> holder;
  for (const Clamp& clamp : clamps) {
    Positions places = places_of<dim>(character.rest.positions, clamp.vertices);
    if (places.rows() > 0) places.rowwise() -= places.row(0).eval();
    const Eigen::JacobiSVD<Eigen::MatrixXd> spread(places);
    if (places.rows() < 3 || !(spread.singularValues()[1] > 1e-9 * spread.singularValues()[0]))
      throw InputError(
          fmt::format("clamp '{}' holds {} vertices: it needs three that are not on a line: make it larger", clamp.name,
                      places.rows()));
    for (const int i : clamp.vertices) {
      const auto [at, is_new] = holder.try_emplace(i, clamp.name);
      if (!is_new)
        throw InputError(
            fmt::format("clamps '{}' and '{}' both hold vertex {}: move them apart", at->second, clamp.name, i));
    }
  }
  if (static_cast<int>(holder.size()) == character.rest.vertex_count())
    throw InputError("the clamps hold every vertex: leave some of the body free");
}

template <int dim>
class ClampPipeline {
 public:
  ClampPipeline(const Solid<dim>& body, const PosedMesh<dim>& character, const std::vector<Clamp>& clamps,
                const ClampPipelineOptions& options, const PipelineObserver& observer)
      : body_(body),
        character_(character),
        clamps_(clamps),
        options_(options),
        report_(observer),
        fixed_(held_by<dim>(character, clamps))
  {}

  std::vector<CharacterStage<dim>> run()
  {
    std::vector<CharacterStage<dim>> stages{uniform_stage()};
    const bool goes_on = options_.last_stage > 2 && !report_.is_stopped() && stages[0].report.converged();
    if (goes_on) stages.push_back(material_stage(stages[0]));
    return stages;
  }

 private:
  CharacterStage<dim> uniform_stage();
  CharacterStage<dim> material_stage(const CharacterStage<dim>& uniform);
  PoseTrace trace(const Vec& densities, std::size_t pose) const;
  void measure(CharacterStage<dim>& stage) const;

  const Solid<dim>& body_;
  const PosedMesh<dim>& character_;
  const std::vector<Clamp>& clamps_;
  const ClampPipelineOptions& options_;
  PipelineWatch report_;
  FixedDofs fixed_;
};

template <int dim>
PoseTrace ClampPipeline<dim>::trace(const Vec& densities, std::size_t pose) const
{
  return trace_pose<dim>(LoadedSolid<dim>(body_, densities), fixed_, [&, pose](double fraction) {
    return clamped_positions<dim>(character_, clamps_, pose, fraction);
  });
}

template <int dim>
CharacterStage<dim> ClampPipeline<dim>::uniform_stage()
{
  CharacterStage<dim> stage;
  stage.number = 2;
  stage.densities = Vec::Constant(body_.element_count(), options_.first_density);
  stage.report.termination = Termination::Converged;
  {
    const Stopwatch watch(stage.seconds);
    for (std::size_t i = 0; i < character_.targets.size(); ++i) {
      if (!report_(2, fmt::format("leading the uniform body into '{}'", character_.names[i]))) break;
      stage.traces.push_back(trace(stage.densities, i));
      stage.positions.push_back(stage.traces.back().x);
      if (stage.traces.back().steps.back().parameter < 1 && stage.report.converged()) {
        stage.report.termination = Termination::Infeasible;
        stage.report.message = fmt::format("the uniform body finds no equilibrium on the way to '{}' beyond {:.0f} %",
                                           character_.names[i], 100 * stage.traces.back().steps.back().parameter);
      }
    }
  }
  stage.trace_seconds = stage.seconds;
  if (report_.is_stopped()) stage.report.termination = Termination::Interrupted;
  measure(stage);
  return stage;
}

template <int dim>
CharacterStage<dim> ClampPipeline<dim>::material_stage(const CharacterStage<dim>& uniform)
{
  CharacterStage<dim> stage;
  stage.number = 3;
  {
    const Stopwatch watch(stage.seconds);
    std::vector<MaterialPose<dim>> poses;
    for (std::size_t i = 0; i < character_.targets.size(); ++i)
      poses.push_back({character_.targets[i], uniform.positions[i], fixed_, {}, {}, {}});
    MaterialDesign<dim> design(body_, std::move(poses), options_.limits);
    const auto first = design.start(uniform.densities);
    if (!first) {
      CharacterStage<dim> failed = uniform;
      failed.number = 3;
      failed.report = {Termination::Infeasible, "no equilibrium at uniform densities", {}, {}, {}};
      return failed;
    }
    MaterialLayout<dim> layout =
        optimize_layout<dim>(design, *first, options_.layout,
                             [this](const LayoutProgress& progress) { return report_(3, describe(progress)); });
    stage.densities = std::move(layout.state.rho);
    stage.positions = std::move(layout.state.x);
    stage.failed_equilibria = layout.refused_moves;
    stage.report = std::move(layout.report);
  }
  if (report_.is_stopped()) {
    stage.report.termination = Termination::Interrupted;
  } else {
    const Stopwatch watch(stage.trace_seconds);
    for (std::size_t i = 0; i < character_.targets.size(); ++i) {
      report_(3, fmt::format("tracing '{}' from rest", character_.names[i]));
      stage.traces.push_back(trace(stage.densities, i));
    }
  }
  measure(stage);
  return stage;
}

template <int dim>
void ClampPipeline<dim>::measure(CharacterStage<dim>& stage) const
{
  measure_stage<dim>(stage, character_.targets, fixed_,
                     [&](std::size_t) { return LoadedSolid<dim>(body_, stage.densities); });
}

}  // namespace

template <int dim>
FixedDofs held_by(const PosedMesh<dim>& character, const std::vector<Clamp>& clamps)
{
  FixedDofs fixed = character.held;
  if (fixed.free.size() == 0) fixed.free = Vec::Ones(character.rest.positions.size());
  for (const Clamp& clamp : clamps)
    for (const int i : clamp.vertices) fixed.free.segment<dim>(dim * i).setZero();
  return fixed;
}

template <int dim>
Vec clamped_positions(const PosedMesh<dim>& character, const std::vector<Clamp>& clamps, std::size_t pose,
                      double fraction)
{
  const Vec& rest = character.rest.positions;
  Vec x = character.way(pose, fraction);
  for (const Clamp& clamp : clamps) {
    const Positions before = places_of<dim>(rest, clamp.vertices);
    const Positions after = rigid_alignment(before, places_of<dim>(x, clamp.vertices))(before);
    for (std::size_t k = 0; k < clamp.vertices.size(); ++k)
      x.template segment<dim>(dim * clamp.vertices[k]) = after.row(Eigen::Index(k)).template head<dim>();
  }
  if (character.held.free.size() == 0) return x;
  return character.held.free.cwiseProduct(x) + (1 - character.held.free.array()).matrix().cwiseProduct(rest);
}

template <int dim>
std::vector<CharacterStage<dim>> run_clamp_pipeline(const Solid<dim>& body, const PosedMesh<dim>& character,
                                                    const std::vector<Clamp>& clamps,
                                                    const ClampPipelineOptions& options,
                                                    const PipelineObserver& observer)
{
  validate<dim>(character, clamps, options);
  return ClampPipeline<dim>(body, character, clamps, options, observer).run();
}

template FixedDofs held_by<2>(const PosedMesh<2>&, const std::vector<Clamp>&);
template FixedDofs held_by<3>(const PosedMesh<3>&, const std::vector<Clamp>&);
template Vec clamped_positions<2>(const PosedMesh<2>&, const std::vector<Clamp>&, std::size_t, double);
template Vec clamped_positions<3>(const PosedMesh<3>&, const std::vector<Clamp>&, std::size_t, double);
template std::vector<CharacterStage<2>> run_clamp_pipeline<2>(const Solid<2>&, const PosedMesh<2>&,
                                                              const std::vector<Clamp>&, const ClampPipelineOptions&,
                                                              const PipelineObserver&);
template std::vector<CharacterStage<3>> run_clamp_pipeline<3>(const Solid<3>&, const PosedMesh<3>&,
                                                              const std::vector<Clamp>&, const ClampPipelineOptions&,
                                                              const PipelineObserver&);

}  // namespace softform
