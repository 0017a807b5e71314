// softform pillow: one or two flat outlines sewn together and inflated, as they are (thesis 6.5).
#include <cmath>
#include <memory>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "commands.hpp"
#include "files.hpp"
#include "options.hpp"
#include "pattern_results.hpp"
#include "progress.hpp"
#include "softform/core/error.hpp"
#include "softform/core/interrupt.hpp"
#include "softform/inflatables/inflatable.hpp"
#include "softform/inflatables/pillow.hpp"
#include "softform/inflatables/sheet_material.hpp"
#include "softform/io/svg_outlines.hpp"
#include "softform/materials/material_file.hpp"

namespace softform::cli {
namespace {

constexpr const char* examples = R"(Examples:
  softform pillow heart.svg --pressure 1kPa --out heart
  softform pillow cushion.svg --pressure 2kPa --material pvc.json --thickness 0.2mm --size 500mm --out cushion
One outline is both front and back. Two are sewn together as they lie on each other, from their first points on at equal
fractions of their lengths; the first is the front. Curves, groups and their transforms are understood.
The sheet's stiffness is the material's at rest; it wrinkles where it would be compressed (relaxed energy).
Writes into DIR:
  inflated.vtp  the shape in metres for ParaView, with panels and the width that is lost in wrinkles
  flat.vtp      the flat sheets, side by side
  metrics.csv   metric,value,unit; SI)";

struct PillowInput {
  std::string drawing, out, material = "mylar";
  std::optional<double> pressure, thickness, size, edge;
};

std::vector<SvgOutline> read_outlines(const PillowInput& input)
{
  std::vector<SvgOutline> outlines = read_svg_outlines(input.drawing);
  if (outlines.size() > 2) {
    std::string names;
    for (const SvgOutline& outline : outlines) names += (names.empty() ? "" : ", ") + outline.name;
    throw InputError(
        fmt::format("{}: {} outlines ({}): a pillow has one or two; delete the others, and make holes closed",
                    input.drawing, outlines.size(), names));
  }
  const Polygon& front = outlines[0].points;
  const double extent = (front.colwise().maxCoeff() - front.colwise().minCoeff()).maxCoeff();
  if (input.size)
    for (SvgOutline& outline : outlines) outline.points *= *input.size / extent;
  return outlines;
}

PanelLayout layout_of(const PillowInput& input, double* edge_length)
{
  const std::vector<SvgOutline> outlines = read_outlines(input);
  // 4000 triangles a sheet unless told otherwise.
  const Polygon& front = outlines.front().points;
  *edge_length = input.edge.value_or(std::sqrt(std::abs(signed_area(front)) / 4000 * 4 / std::sqrt(3.0)));
  if (signed_area(front) / (*edge_length * *edge_length) > 2e5)
    throw InputError(
        fmt::format("--edge: edges of {:g} mm make more than half a million triangles a sheet: make it longer",
                    1e3 * *edge_length));
  try {
    return pillow(front, outlines.back().points, *edge_length);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", input.drawing, error.what()));
  }
}

ExitCode run(const PillowInput& input)
{
  require_writable(input.out);
  const std::shared_ptr<const Material> material = load_material(input.material);
  double edge_length = 0;
  const PanelLayout layout = layout_of(input, &edge_length);

  catch_interrupts();
  Progress progress;
  progress.step(fmt::format("inflating {} triangles", layout.triangle_count()));
  const double size = (layout.nodes.colwise().maxCoeff() - layout.nodes.colwise().minCoeff()).norm();
  const Inflatable inflatable(layout, sheet_material(*material, *input.thickness, *input.pressure, size),
                              *input.thickness, *input.pressure);
  const Vec flat = flat_vector(layout);
  SparseFactorization factorization;
  const Equilibrium equilibrium = inflate(inflatable, flat, flatten(layout.nodes), factorization);
  progress.end();

  const Vec compression = inflatable.compression(equilibrium.x, flat);
  const Positions nodes = unflatten(equilibrium.x);
  const Eigen::RowVector3d extent = nodes.colwise().maxCoeff() - nodes.colwise().minCoeff();
  write_vtp(input.out + "/inflated.vtp", {nodes, node_triangles(layout)},
            {{}, {panel_field(layout), {"compression [1]", compression}}});
  write_flat_panels(input.out, layout);
  write_metrics(input.out,
                {{"pressure", *input.pressure, "Pa"},
                 {"volume", inflatable.volume().value(equilibrium.x), "m^3"},
                 {"width", extent.x(), "m"},
                 {"height", extent.y(), "m"},
                 {"thickness", extent.z(), "m"},
                 {"max_stretch", inflatable.membrane().principal_stretches(equilibrium.x, flat).maxCoeff(), "1"},
                 {"max_compression", compression.maxCoeff(), "1"},
                 {"triangles", double(layout.triangle_count()), "1"},
                 {"edge_length", edge_length, "m"},
                 {"max_residual", equilibrium.residual, "1"},
                 {"newton_iterations", double(equilibrium.iterations), "1"},
                 {"time", progress.elapsed_s(), "s"}});
  if (equilibrium.report.converged()) return Success;
  if (equilibrium.report.termination == Termination::Interrupted) {
    spdlog::warn("interrupted: the last state on the way is in {}", input.out);
    return Interrupted;
  }
  spdlog::error("no equilibrium was reached ({}); the last state on the way is in {}", equilibrium.report.message,
                input.out);
  return NotReached;
}

}  // namespace

void add_pillow_command(CLI::App& program, ExitCode& exit_code)
{
  CLI::App* command = program.add_subcommand("pillow", "Inflate one or two flat outlines sewn together");
  auto input = std::make_shared<PillowInput>();
  input->thickness = 25e-6;
  command->add_option("DRAWING", input->drawing, "Outlines of the flat sheets: SVG")->required();
  add_pressure(*command, "--pressure", input->pressure, "Pressure inside above that outside, for example 1kPa")
      ->required();
  command->add_option("--material", input->material, "Material: a JSON file, or a name (mylar)")
      ->type_name("FILE|NAME");
  add_length(*command, "--thickness", input->thickness, "Thickness of the sheets (25um)");
  add_length(*command, "--size", input->size,
             "Width or height of the front outline, the larger one;\nwithout it, as drawn");
  add_length(*command, "--edge", input->edge, "Edges of the triangles; without it, 4000 triangles a sheet");
  command->add_option("--out", input->out, "Folder for the results; created if need be")->required()->type_name("DIR");
  command->footer(examples);
  command->callback([input, &exit_code] { exit_code = run(*input); });
}

}  // namespace softform::cli
