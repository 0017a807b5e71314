#include "softform/characters/character_design.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "softform/characters/string_pipeline.hpp"
#include "softform/io/vtk_io.hpp"

namespace softform {
namespace {

PinPipelineOptions pin_options(const CharacterTask& task, const PosedMesh<2>& body)
{
  PinPipelineOptions options;
  options.actuators = task.range;
  options.vertices = task.vertices;
  options.held = body.held;
  options.last_stage = task.last_stage();
  options.first_density = task.first_density;
  options.placement.weights = task.placement;
  options.layout = task.layout;
  options.first_traced_stage = options.last_stage;
  options.way = body.way;
  return options;
}

template <int dim>
const PosedMesh<dim>& body_of(const CharacterTask& task)
{
  return std::get<PosedMesh<dim>>(task.body);
}

CharacterDesign<2> design_with_pins(const CharacterTask& task, const PipelineObserver& observer)
{
  const PosedMesh<2>& body = body_of<2>(task);
  const Solid<2> solid = make_solid<2>(task);
  CharacterDesign<2> design;
  for (PinStage& stage : run_pin_pipeline(solid, body.targets, pin_options(task, body), observer)) {
    design.pins.push_back(std::move(stage.pins));
    design.stages.push_back(std::move(stage));
  }
  return design;
}

template <int dim>
CharacterDesign<dim> design_with_clamps(const CharacterTask& task, const PipelineObserver& observer)
{
  ClampPipelineOptions options;
  options.last_stage = task.last_stage();
  options.first_density = task.first_density;
  options.layout = task.layout;
  const Solid<dim> solid = make_solid<dim>(task);
  CharacterDesign<dim> design;
  design.stages = run_clamp_pipeline<dim>(solid, body_of<dim>(task), task.clamps, options, observer);
  return design;
}

CharacterDesign<2> design_with_strings(const CharacterTask& task, const PipelineObserver& observer)
{
  StringPipelineOptions options;
  options.strings = task.range.most;
  options.ring_margin = task.ring_margin;
  options.last_stage = task.last_stage();
  options.placement.weights.sliding = {task.placement.boundary, task.placement.repulsion};
  const Solid<2> solid = make_solid<2>(task);
  CharacterDesign<2> design;
  for (StringStage& stage : run_string_pipeline(solid, body_of<2>(task), options, observer)) {
    design.strings.push_back(std::move(stage.plan));
    design.stages.push_back(std::move(stage));
  }
  return design;
}

// Relative to that at rest; NaN where an unstable state was passed.
double smallest_eigenvalue_of(const PoseTrace& trace)
{
  double smallest = std::numeric_limits<double>::infinity();
  for (const TraceStep& step : trace.steps) {
    if (std::isnan(step.relative_eigenvalue)) return step.relative_eigenvalue;
    smallest = std::min(smallest, step.relative_eigenvalue);
  }
  return smallest;
}

std::string how_reached(const PoseTrace& trace)
{
  if (trace.is_reached)
    return fmt::format("reached from rest; the smallest eigenvalue falls to {:.2g} of that at rest",
                       smallest_eigenvalue_of(trace));
  if (trace.steps.back().parameter < 1)
    return fmt::format("NOT reached from rest: no equilibrium beyond {:.1f} % of the way",
                       100 * trace.steps.back().parameter);
  if (trace.snapped_at >= 0)
    return fmt::format("reached only past a buckling point: it snaps at {:.1f} % of the way", 100 * trace.snapped_at);
  return "reached only through unstable states: lead it there by hand";
}

template <int dim>
Vec distances_to(const Vec& x, const Vec& target)
{
  Vec distances(x.size() / dim);
  for (Eigen::Index i = 0; i < distances.size(); ++i) distances[i] = (x - target).template segment<dim>(dim * i).norm();
  return distances;
}

}  // namespace

template <int dim>
std::size_t CharacterDesign<dim>::made_stage() const
{
  for (std::size_t k = stages.size(); k-- > 0;)
    if (stages[k].report.converged() && stages[k].grey_elements == 0) return k;
  return stages.size() - 1;
}

template <int dim>
int CharacterDesign<dim>::actuators(const CharacterTask& task, std::size_t stage) const
{
  if (!pins.empty()) return pins[stage].count();
  return static_cast<int>(strings.empty() ? task.clamps.size() : strings[stage].strings.size());
}

template <>
CharacterDesign<2> design_character<2>(const CharacterTask& task, const PipelineObserver& observer)
{
  CharacterDesign<2> design;
  if (task.kind == ActuatorKind::Pins)
    design = design_with_pins(task, observer);
  else if (task.kind == ActuatorKind::Clamps)
    design = design_with_clamps<2>(task, observer);
  else
    design = design_with_strings(task, observer);
  const std::vector<std::string> known = stage_names(task.kind);
  design.names.assign(known.begin(), known.begin() + std::ssize(design.stages));
  return design;
}

template <>
CharacterDesign<3> design_character<3>(const CharacterTask& task, const PipelineObserver& observer)
{
  CharacterDesign<3> design = design_with_clamps<3>(task, observer);
  const std::vector<std::string> known = stage_names(task.kind);
  design.names.assign(known.begin(), known.begin() + std::ssize(design.stages));
  return design;
}

template <int dim>
std::vector<Metric> design_metrics(const CharacterTask& task, const CharacterDesign<dim>& design)
{
  std::vector<Metric> metrics;
  const std::vector<std::string>& poses = body_of<dim>(task).names;
  double seconds = 0;
  int failed = 0;
  for (std::size_t k = 0; k < design.stages.size(); ++k) {
    const CharacterStage<dim>& stage = design.stages[k];
    const auto add = [&, &name = design.names[k]](const std::string& what, double value, const char* unit) {
      metrics.push_back({fmt::format("{}_{}", what, name), value, unit});
    };
    for (std::size_t i = 0; i < stage.errors.size(); ++i) {
      const auto add_pose = [&](const char* what, double value, const char* unit) {
        metrics.push_back({fmt::format("{}_{}_{}", what, design.names[k], poses[i]), value, unit});
      };
      add_pose("max_error", stage.errors[i].max, "m");
      add_pose("mean_error", stage.errors[i].mean, "m");
      add_pose("negative_eigenvalues", stage.negative_eigenvalues[i], "1");
      add_pose("residual", stage.residuals[i], "1");
      if (i < stage.traces.size()) add_pose("reached", stage.traces[i].is_reached ? 1 : 0, "1");
    }
    add("mean_error", stage.mean_error(), "m");
    add("mean_max_error", stage.mean_max_error(), "m");
    add("actuators", design.actuators(task, k), "1");
    add("grey_elements", stage.grey_elements, "1");
    add("failed_equilibria", stage.failed_equilibria, "1");
    add("time", stage.seconds, "s");
    seconds += stage.seconds;
    failed += stage.failed_equilibria;
  }
  const CharacterStage<dim>& last = design.stages.back();
  const auto& unstable = last.negative_eigenvalues;
  metrics.insert(metrics.end(),
                 {{"mean_error", last.mean_error(), "m"},
                  {"mean_max_error", last.mean_max_error(), "m"},
                  {"actuators", double(design.actuators(task, design.stages.size() - 1)), "1"},
                  {"grey_elements", double(last.grey_elements), "1"},
                  {"negative_eigenvalues", double(std::accumulate(unstable.begin(), unstable.end(), 0)), "1"},
                  {"failed_equilibria", double(failed), "1"},
                  {"elements", double(last.densities.size()), "1"},
                  {"time", seconds, "s"}});
  return metrics;
}

template <int dim>
std::string pose_table(const CharacterTask& task, const CharacterDesign<dim>& design)
{
  std::string text =
      "stage,pose,max_error [m],mean_error [m],residual,negative_eigenvalues,reached,smallest_relative_eigenvalue\n";
  for (std::size_t k = 0; k < design.stages.size(); ++k) {
    const CharacterStage<dim>& stage = design.stages[k];
    for (std::size_t i = 0; i < stage.errors.size(); ++i) {
      const bool is_traced = i < stage.traces.size();
      text += fmt::format("{},{},{:.6g},{:.6g},{:.3g},{},{},{}\n", design.names[k], body_of<dim>(task).names[i],
                          stage.errors[i].max, stage.errors[i].mean, stage.residuals[i], stage.negative_eigenvalues[i],
                          is_traced ? (stage.traces[i].is_reached ? "yes" : "no") : "",
                          is_traced ? fmt::format("{:.4g}", smallest_eigenvalue_of(stage.traces[i])) : "");
    }
  }
  return text;
}

template <int dim>
std::string design_report(const CharacterTask& task, const CharacterDesign<dim>& design)
{
  std::string text = fmt::format("{}\n", task.source);
  for (std::size_t k = 0; k < design.stages.size(); ++k) {
    const CharacterStage<dim>& stage = design.stages[k];
    text += fmt::format("\nStage {}: {}{}{}, {:.1f} s\n", design.names[k], to_string(stage.report.termination),
                        stage.report.message.empty() ? "" : ": ", stage.report.message, stage.seconds);
    text += fmt::format("  {} actuators\n", design.actuators(task, k));
    if (stage.failed_equilibria > 0)
      text += fmt::format("  {} equilibria were not found on the way; each refused a step\n", stage.failed_equilibria);
    if (stage.grey_elements > 0) text += fmt::format("  {} elements are neither soft nor stiff\n", stage.grey_elements);
    for (std::size_t i = 0; i < stage.errors.size(); ++i) {
      text += fmt::format("  {}: largest error {:.3f} mm, mean {:.3f} mm{}{}\n", body_of<dim>(task).names[i],
                          1e3 * stage.errors[i].max, 1e3 * stage.errors[i].mean,
                          stage.residuals[i] < 1e-6 ? "" : "; NOT an equilibrium",
                          stage.negative_eigenvalues[i] == 0 ? "" : "; NOT stable");
      if (i < stage.traces.size()) text += fmt::format("    {}\n", how_reached(stage.traces[i]));
    }
  }
  return text;
}

template <int dim>
void write_stages(const std::filesystem::path& folder, const CharacterTask& task, const CharacterDesign<dim>& design)
{
  const PosedMesh<dim>& body = body_of<dim>(task);
  const Vec& densities = design.stages.back().densities;
  write_vtu<dim>(folder / "rest.vtu", body.rest, {}, {{"density [1]", densities}});
  for (std::size_t i = 0; i < body.targets.size(); ++i)
    write_vtu<dim>(folder / fmt::format("target_{}.vtu", body.names[i]), {body.targets[i], body.rest.elements}, {},
                   {{"density [1]", densities}});
  for (std::size_t k = 0; k < design.stages.size(); ++k) {
    const CharacterStage<dim>& stage = design.stages[k];
    for (std::size_t i = 0; i < stage.positions.size(); ++i)
      write_vtu<dim>(folder / fmt::format("{}_{}.vtu", design.names[k], body.names[i]),
                     {stage.positions[i], body.rest.elements},
                     {{"distance [m]", distances_to<dim>(stage.positions[i], body.targets[i])}},
                     {{"density [1]", stage.densities}});
  }
}

template struct CharacterDesign<2>;
template struct CharacterDesign<3>;
template std::vector<Metric> design_metrics<2>(const CharacterTask&, const CharacterDesign<2>&);
template std::vector<Metric> design_metrics<3>(const CharacterTask&, const CharacterDesign<3>&);
template std::string pose_table<2>(const CharacterTask&, const CharacterDesign<2>&);
template std::string pose_table<3>(const CharacterTask&, const CharacterDesign<3>&);
template std::string design_report<2>(const CharacterTask&, const CharacterDesign<2>&);
template std::string design_report<3>(const CharacterTask&, const CharacterDesign<3>&);
template void write_stages<2>(const std::filesystem::path&, const CharacterTask&, const CharacterDesign<2>&);
template void write_stages<3>(const std::filesystem::path&, const CharacterTask&, const CharacterDesign<3>&);

}  // namespace softform
