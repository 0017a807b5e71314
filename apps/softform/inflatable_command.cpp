// softform inflatable: the flat panels that, sewn together and inflated, take the shape of a target (thesis, chapter
// 6).
#include <limits>
#include <memory>
#include <utility>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "commands.hpp"
#include "files.hpp"
#include "options.hpp"
#include "panels_input.hpp"
#include "pattern_results.hpp"
#include "softform/core/error.hpp"
#include "softform/core/interrupt.hpp"
#include "softform/inflatables/pattern_optimization.hpp"
#include "softform/inflatables/preview_time.hpp"
#include "softform/inflatables/sheet_material.hpp"
#include "softform/materials/material_file.hpp"
#include "softform/mesh/alignment.hpp"

namespace softform::cli {
namespace {

constexpr const char* examples = R"(Examples:
  softform inflatable bear.off --seams bear.json --material mylar --size 40cm --out bear
  softform inflatable sofa.stl --seams sofa.json --material pvc.json --thickness 0.4mm --pressure 3kPa --size 2m \
    --allowance 15mm --sheet 140cmx300cm --out sofa
The target is cut along its seams, the panels are flattened, and then optimised until they inflate into the target, both
sides of every seam equally long and its seams where they were drawn. Ctrl-C ends that with the panels so far: they can
be cut at any time, only not yet the best ones. The sheet's stiffness is the material's at rest; it wrinkles where it
would be compressed (relaxed energy).
)";

constexpr const char* results = R"(Writes into DIR:
  inflated.vtp       the inflated shape in metres for ParaView, with panels, width lost in wrinkles, distance to the target
  panels.svg, .dxf   all sheets in millimetres, a layer each for cut, seam, notches, labels and grain
  panels.pdf         the same at true scale on tiled A4
  flat.vtp           the flat panels, side by side
  seams.csv          lengths of every seam on both its sides, and their mismatch
  trace.csv          the iterations of the optimiser
  metrics.csv        what came out (metric,value,unit; SI); distances are in units of the target's longest side)";

struct InflatableInput : PanelsInput {
  std::string material;
  std::optional<double> pressure, thickness;
  int iterations = 0, triangles = 3000;
};

/// Sheets that stretch more than they can be cut to are no inextensible ones.
void require_stiff_sheets(const Material& material, double thickness, double pressure, double size)
{
  constexpr double largest_strain = 0.05;
  // p R / (2 h E) in a sphere of half the size, E three times the shear modulus.
  const double strain = pressure * size / 4 / (3 * material.shear_modulus() * thickness);
  if (strain > largest_strain)
    throw InputError(
        fmt::format("--pressure: {:g} kPa stretches sheets of {:g} mm of this material by {:.0f} % or more, and panels "
                    "are made of what hardly stretches: take a lower pressure, a thicker sheet or a stiffer material",
                    1e-3 * pressure, 1e3 * thickness, 100 * strain));
}

/// The panels as they are, or meshed anew with about as many triangles as asked for where they have more (0: never).
PanelLayout coarsened(PanelLayout layout, const PatternTarget& target, int triangles)
{
  constexpr int fewest_per_panel = 20;
  const int fewest = fewest_per_panel * static_cast<int>(layout.panels.size());
  if (triangles == 0 || layout.triangle_count() <= triangles) return layout;
  if (triangles < fewest)
    throw InputError(fmt::format("--triangles: {} for {} panels are too few to take a shape: take {} or more",
                                 triangles, layout.panels.size(), fewest));
  return with_triangles(layout, target.distance(), triangles);
}

/// The skins, moved to lie as close to the target as they can.
TriangleMesh aligned_skin(const InflatedPanels& panels, const PatternTarget& target)
{
  constexpr int samples = 5000;
  TriangleMesh skin = skin_mesh(panels.layout, panels.x);
  skin.vertices = rigid_alignment(sample_surface(skin, samples), target.distance())(skin.vertices);
  return skin;
}

/// What is measured on the way.
struct Course {
  double unoptimised_mean_distance = 0, preview_time = 0, time = 0;
  PreviewTime preview;
};

PatternObserver observer(Progress& progress, Course& course)
{
  return [&progress, &course](const PatternProgress& now) {
    course.preview.record(progress.elapsed_s(), skin_mesh(now.panels.layout, now.panels.x));
    progress.step(fmt::format("iteration {}, objective {:.5g}, stationary to {:.1e}, meshed anew {} times",
                              now.iterate.k, now.iterate.objective, now.iterate.stationarity, now.remeshings));
    return !interrupted();
  };
}

void write_inflated(const std::string& out, const InflatedPanels& panels, const PatternTarget& target,
                    const InflationSettings& inflation)
{
  const PanelLayout& layout = panels.layout;
  const Inflatable inflatable(layout, inflation.material, inflation.thickness, inflation.pressure);
  Vec distance = target.distance().distances(unflatten(panels.x));
  for (const Panel& panel : layout.panels) {
    if (!panel.is_wall) continue;
    for (int v = panel.first_vertex; v < panel.first_vertex + panel.vertex_count; ++v)
      distance[layout.node_of[std::size_t(v)]] = 0;  // inside there is nothing to be close to
  }
  write_vtp(out + "/inflated.vtp", {unflatten(panels.x), node_triangles(layout)},
            {{{"distance [m]", distance}},
             {panel_field(layout), {"compression [1]", inflatable.compression(panels.x, flat_vector(layout))}}});
}

/// The sheets; larger ones, and a warning, when optimised panels have outgrown those that were asked for.
std::vector<PatternPiece> sheets_for(const PanelLayout& layout, SheetSettings settings)
{
  const std::vector<PatternPiece> pieces = pattern_pieces(layout, settings.pieces);
  std::string problem;
  for (;; settings.nesting.sheet_width *= 1.1, settings.nesting.sheet_height *= 1.1) {
    try {
      std::vector<PatternPiece> sheets = nested(pieces, settings.nesting);
      if (!problem.empty())
        spdlog::warn("the panels grew: {}; they are drawn on sheets of {:.0f} x {:.0f} mm", problem,
                     1e3 * settings.nesting.sheet_width, 1e3 * settings.nesting.sheet_height);
      return sheets;
    } catch (const InputError& error) {
      if (problem.empty()) problem = error.what();
    }
  }
}

void write_design_metrics(const std::string& out, const PatternOptimum& optimum, const PatternTarget& target,
                          const Course& course)
{
  const PanelLayout& layout = optimum.panels.layout;
  const ShapeDistance distance = sampled_distance(aligned_skin(optimum.panels, target), target.distance());
  const SeamMismatch mismatch = seam_mismatch(layout);
  const int iterations = optimum.report.trace.empty() ? 0 : optimum.report.trace.back().k;
  write_metrics(out, {{"panels", double(layout.panels.size())},
                      {"inner_panels", double(wall_count(layout))},
                      {"triangles", double(layout.triangle_count())},
                      {"mean_distance", distance.mean / target.size()},
                      {"max_distance", distance.max / target.size()},
                      {"unoptimised_mean_distance", course.unoptimised_mean_distance / target.size()},
                      {"seam_mismatch_mean", mismatch.mean},
                      {"seam_mismatch_max", mismatch.max},
                      {"smallest_quality", flat_quality(layout).minCoeff<Eigen::PropagateNaN>()},
                      {"max_residual", optimum.residual},
                      {"iterations", double(iterations)},
                      {"remeshings", double(optimum.remeshings)},
                      {"preview_time", course.preview.within(0.05 * target.size()), "s"},
                      {"time", course.time, "s"}});
}

/// Returns false where an optimised panel overlaps itself and so cannot be cut: that is no fault of the input.
bool write_sheets(const std::string& out, const PanelLayout& layout, const SheetSettings& settings)
{
  std::vector<PatternPiece> sheets;
  try {
    sheets = sheets_for(layout, settings);
  } catch (const InputError& error) {
    spdlog::error("no sheets to cut: {}", error.what());
    return false;
  }
  write_pattern(out, layout, sheets);
  return true;
}

/// Replaces the inflated shape by that of the relaxed energy itself, without what the design makes smooth.
void predict(PatternOptimum& optimum, const InflationSettings& inflation)
{
  Equilibrium predicted = inflate_again(optimum.panels, inflation);
  if (!predicted.report.converged())
    return spdlog::warn(
        "the panels found no equilibrium under the relaxed energy ({}): the shape written is that of "
        "the design, with gradual wrinkles",
        predicted.report.message);
  optimum.panels.x = std::move(predicted.x);
  optimum.residual = predicted.residual;
}

ExitCode conclude(const Report& report, const std::string& out)
{
  if (report.termination == Termination::Interrupted) {
    spdlog::warn("interrupted: the panels so far and what they inflate into are in {}", out);
    return Interrupted;
  }
  if (!report.converged()) {
    const char* cure = report.termination == Termination::IterationLimit ? "" : ": fewer --triangles may reach them";
    spdlog::error("the best panels were not reached ({}: {}){}; those so far are in {}", to_string(report.termination),
                  report.message, cure, out);
    return NotReached;
  }
  spdlog::info("{}; the results are in {}", report.message, out);
  return Success;
}

ExitCode run(const InflatableInput& input)
{
  const SheetSettings sheets = sheet_settings(input);
  require_writable(input.out);
  const std::shared_ptr<const Material> material = load_material(input.material);
  Progress progress;
  CutTarget cut = cut_target(input, progress);
  const PatternTarget target(std::move(cut.target));
  require_stiff_sheets(*material, *input.thickness, *input.pressure, target.size());
  require_fit(cut.layout, sheets);

  cut.layout = coarsened(std::move(cut.layout), target, input.triangles);

  catch_interrupts();
  const double size = target.size();
  const InflationSettings inflation = design_inflation(*material, *input.thickness, *input.pressure, size);
  progress.step(
      fmt::format("inflating {} panels of {} triangles", cut.layout.panels.size(), cut.layout.triangle_count()));
  const InflatedPanels start = inflated_panels(std::move(cut.layout), inflation);
  Course course;
  course.unoptimised_mean_distance = sampled_distance(aligned_skin(start, target), target.distance()).mean;
  PatternOptions options;
  if (input.iterations > 0) options.stop.max_iterations = input.iterations;
  PatternOptimum optimum = optimize_pattern(start, target, inflation, options, observer(progress, course));
  progress.step("inflating the panels");
  const InflationSettings sheets_as_they_are = sheet_inflation(*material, *input.thickness, *input.pressure, size);
  if (!interrupted()) predict(optimum, sheets_as_they_are);
  course.time = progress.elapsed_s();
  progress.end();

  write_inflated(input.out, optimum.panels, target, sheets_as_they_are);
  write_flat_panels(input.out, optimum.panels.layout);
  write_trace(input.out, optimum.report);
  write_design_metrics(input.out, optimum, target, course);
  const bool can_be_cut = write_sheets(input.out, optimum.panels.layout, sheets);
  const ExitCode exit_code = conclude(optimum.report, input.out);
  return can_be_cut || exit_code == Interrupted ? exit_code : NotReached;
}

}  // namespace

void add_inflatable_command(CLI::App& program, ExitCode& exit_code)
{
  CLI::App* command = program.add_subcommand("inflatable", "Design the flat panels that inflate into a target shape");
  auto input = std::make_shared<InflatableInput>();
  input->thickness = 25e-6;
  input->pressure = 1e3;
  add_panels_input(*command, *input);
  command->add_option("--material", input->material, "Material: a JSON file, or a name such as mylar")
      ->required()
      ->type_name("FILE|NAME");
  add_pressure(*command, "--pressure", input->pressure, "Pressure inside above that outside [1kPa]");
  add_length(*command, "--thickness", input->thickness, "Thickness of the sheets [25um]");
  command
      ->add_option("--triangles", input->triangles,
                   "Panels with more triangles are meshed anew with about so many, which is faster; 0: never [3000]")
      ->check(CLI::Range(0, 1'000'000));
  command->add_option("--iterations", input->iterations, "At most so many iterations [500]")
      ->check(CLI::Range(1, 100'000));
  command->footer(std::string(examples) + seam_file_help + results);
  command->callback([input, &exit_code] { exit_code = run(*input); });
}

}  // namespace softform::cli
