// softform balloon: the rest shape of a rubber balloon that inflates into a given target (thesis, chapter 4).
#include <limits>
#include <memory>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "commands.hpp"
#include "files.hpp"
#include "nozzle_options.hpp"
#include "options.hpp"
#include "progress.hpp"
#include "softform/balloons/balloon_design.hpp"
#include "softform/core/error.hpp"
#include "softform/core/interrupt.hpp"
#include "softform/io/mesh_io.hpp"
#include "softform/io/vtk_io.hpp"
#include "softform/materials/material_file.hpp"
#include "softform/mesh/distance.hpp"
#include "softform/mesh/self_intersections.hpp"

namespace softform::cli {
namespace {

constexpr const char* examples = R"(Examples:
  softform balloon bunny.off --material silicone --thickness 0.3mm --size 146mm --out bunny
  softform balloon teddy.stl --material my_rubber.json --thickness 0.2mm --scale 0.4 --out teddy
  softform balloon bunny.off --material silicone --thickness 0.3mm --size 146mm --nozzle -y --out bunny
The target is scaled down and inflated to its own volume, which gives the pressure; then the rest shape is optimised
until the balloon inflates into the target, and sized to enclose the target's volume. Ctrl-C ends the optimisation with the best rest shape so far.
Lengths take um, mm, cm, m, in. A bare number is refused.
Writes into DIR:
  rest.stl, rest.vtp  the balloon to fabricate (STL in millimetres, VTP in metres for ParaView)
  rest.obj            with --nozzle, in millimetres: what softform mould makes a mould of
  inflated.vtp        what it inflates into, with its distance to the target
  downscaled.vtp      what the merely downscaled target inflates into at the same volume, to compare
  trace.csv           the iterations of the optimiser
  metrics.csv         distances to the target, pressure, checks of the result (metric,value,unit; SI))";

/// Largest residual of an equilibrium worth the name, relative to a fully unbalanced vertex.
constexpr double largest_residual = 1e-6;

struct BalloonCommandInput : BalloonInput {
  std::optional<double> scale;
  std::optional<double> vertex_distance;
  NozzleInput nozzle;
};

BalloonObserver observer(Progress& progress)
{
  return [&progress](const BalloonProgress& now) {
    if (now.iterate == nullptr)
      progress.step(now.phase);
    else
      progress.step(
          fmt::format("{}: iteration {}, objective {:.5g}", now.phase, now.iterate->k, now.iterate->objective));
    return !interrupted();
  };
}

bool is_stable(const BalloonDesign& design)
{
  return design.negative_eigenvalues == 0 && design.residual <= largest_residual;
}

void write_shapes(const std::string& out, const BalloonDesign& design, const TriangleMesh& target)
{
  TriangleMesh in_millimetres = design.rest;
  in_millimetres.vertices *= 1e3;
  write_mesh(out + "/rest.stl", in_millimetres);
  if (design.nozzle) write_mesh(out + "/rest.obj", in_millimetres);
  write_vtp(out + "/rest.vtp", design.rest);
  Vec distance;
  shape_distance(aligned_to(target, flatten(design.inflated.vertices)), target, &distance);
  write_vtp(out + "/inflated.vtp", design.inflated,
            {{{"distance [m]", distance}}, {stretch_field(design.inflated, design.rest)}});
  shape_distance(aligned_to(target, flatten(design.downscaled.vertices)), target, &distance);
  write_vtp(out + "/downscaled.vtp", design.downscaled, {{{"distance [m]", distance}}, {}});
}

void write_balloon_metrics(const std::string& out, const BalloonDesign& design, const TriangleMesh& target,
                           int self_intersections, double time)
{
  // A nozzle holds them where they are: without alignment a bent neck counts for more than the shape.
  const TriangleMesh inflated = aligned_to(target, flatten(design.inflated.vertices));
  const ShapeDistance optimised = shape_distance(inflated, target);
  const ShapeDistance downscaled = shape_distance(aligned_to(target, flatten(design.downscaled.vertices)), target);
  const bool is_checked = design.negative_eigenvalues >= 0;  // else it ended before there was an equilibrium to check
  const auto known = [is_checked](double value) {
    return is_checked ? value : std::numeric_limits<double>::quiet_NaN();
  };
  const int iterations = design.report.trace.empty() ? 0 : design.report.trace.back().k;
  write_metrics(out, {{"mean_distance", optimised.mean, "m"},
                      {"max_distance", optimised.max, "m"},
                      {"downscaled_mean_distance", downscaled.mean, "m"},
                      {"downscaled_max_distance", downscaled.max, "m"},
                      {"pressure", design.pressure, "Pa"},
                      {"mean_stretch", known(design.mean_stretch), "1"},
                      {"max_residual", known(design.residual), "1"},
                      {"negative_eigenvalues", known(design.negative_eigenvalues), "1"},
                      {"self_intersections", double(self_intersections), "1"},
                      {"hausdorff_distance", hausdorff_distance(inflated, target), "m"},
                      {"iterations", double(iterations), "1"},
                      {"time", time, "s"}});
}

ExitCode conclude(const BalloonDesign& design, int self_intersections, const std::string& out)
{
  const Termination termination = design.report.termination;
  if (termination == Termination::Interrupted) {
    spdlog::warn("interrupted: the best rest shape so far is in {}", out);
    return Interrupted;
  }
  if (termination == Termination::Infeasible || termination == Termination::NotFinite || !is_stable(design)) {
    spdlog::error("no stable equilibrium was reached ({}: {}); what was computed is in {}", to_string(termination),
                  design.report.message, out);
    return NotReached;
  }
  if (self_intersections > 0)
    spdlog::warn("the rest shape cuts itself in {} places: it cannot be made as it is; try a larger --scale",
                 self_intersections);
  spdlog::info("{}: {}; the results are in {}", to_string(termination), design.report.message, out);
  if (design.nozzle)
    spdlog::info("its mould: softform mould {}/rest.obj --nozzle {} --nozzle-diameter {:g}mm --out {}/mould", out,
                 design.nozzle->centre, 2e3 * design.nozzle->radius, out);
  return Success;
}

ExitCode run(const BalloonCommandInput& input)
{
  BalloonOptions options;
  options.thickness = *input.thickness;
  options.rest_scale = input.scale.value_or(options.rest_scale);
  options.vertex_distance_weight = input.vertex_distance.value_or(options.vertex_distance_weight);
  options.nozzle = nozzle_placement(input.nozzle);
  if (options.rest_scale >= 1)
    throw InputError(
        fmt::format("--scale: {} is not below 1: a balloon must be smaller at rest than inflated", options.rest_scale));
  require_writable(input.out);
  const std::shared_ptr<const Material> material = load_material(input.material);
  const TriangleMesh target = read_closed_mesh(input.mesh, input.size);

  catch_interrupts();
  Progress progress;
  const BalloonDesign design = design_balloon(target, material, options, observer(progress));
  progress.end();
  write_shapes(input.out, design, target);
  write_trace(input.out, design.report);
  const int self_intersections = count_self_intersections(design.rest);
  write_balloon_metrics(input.out, design, target, self_intersections, progress.elapsed_s());
  return conclude(design, self_intersections, input.out);
}

}  // namespace

void add_balloon_command(CLI::App& program, ExitCode& exit_code)
{
  CLI::App* command = program.add_subcommand("balloon", "Design the balloon that inflates into a target shape");
  auto input = std::make_shared<BalloonCommandInput>();
  add_balloon_input(*command, *input, "TARGET");
  add_number(*command, "--scale", input->scale, 0,
             "Size of the first rest shape relative to the target, below 1 [0.5]:\nthe rubber stretches by about its "
             "inverse");
  add_number(
      *command, "--vertex-distance", input->vertex_distance, 0,
      "Weight of the distance between corresponding vertices, beside\nlengths and angles [off; 10 is a good value: "
      "closer in position, longer to\ncompute]");
  add_nozzle(*command, input->nozzle);
  command->footer(examples);
  command->callback([input, &exit_code] { exit_code = run(*input); });
}

}  // namespace softform::cli
