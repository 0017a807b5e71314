// softform panels: the flat panels between the seams of a target, to be cut (thesis, sections 6.4.2 and 6.6.2).
#include <algorithm>
#include <array>
#include <memory>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "commands.hpp"
#include "files.hpp"
#include "options.hpp"
#include "progress.hpp"
#include "softform/core/error.hpp"
#include "softform/core/units.hpp"
#include "softform/inflatables/cut_panels.hpp"
#include "softform/inflatables/flatten.hpp"
#include "softform/inflatables/nesting.hpp"
#include "softform/inflatables/pattern_files.hpp"
#include "softform/io/mesh_io.hpp"
#include "softform/io/text_file.hpp"
#include "softform/io/vtk_io.hpp"
#include "softform/mesh/check.hpp"
#include "softform/mesh/relax.hpp"
#include "softform/mesh/remesh.hpp"

namespace softform::cli {
namespace {

constexpr const char* examples = R"(Example:
  softform panels bear.off --seams bear.json --size 40cm --allowance 8mm --sheet 600x400mm --out bear
The target is cut along its seams and each panel is flattened; how they deform under pressure is not yet looked at.
The seam file's coordinates are those of the target's file:
  {"seams": [{"name": "neck", "closed": true, "points": [[0, 1, 2], [1, 1, 2], [0, 1, 3]]},
             {"name": "back", "points": [{"on": "neck", "at": 0.5}, [0, 0, 3], [0, -1, 2]]}],
   "walls": [{"name": "brace", "between": ["neck", "back"]}],
   "panels": [{"name": "head", "inside": [0, 2, 2]}]}
A point [x, y, z] is projected to the target; {"on": SEAM, "at": FRACTION} or {"on": SEAM, "near": [x, y, z]} lies on an
earlier seam. "weight" says how much a seam has to stay in its place (1). Walls and panels' names may be left out.
Writes into DIR:
  panels.svg, .dxf   all sheets in millimetres, a layer each for cut, seam, notches, labels and grain
  panels.pdf         the same at true scale on tiled A4
  seams.csv          lengths of every seam on both its sides, and their mismatch
  target.vtp         the target with its panels, in metres for ParaView; flat.vtp the flat panels
  metrics.csv        what came out (metric,value,unit; SI))";

struct PanelsInput {
  std::string mesh, seams, out;
  std::string flattening = "symmetric-dirichlet", sheet = "600x400mm";
  std::optional<double> size, allowance, notches;
  int vertices = 0;
  bool keeps_grain = false;
};

/// "600x400mm" or "60cm x 40cm", in metres.
std::array<double, 2> parse_sheet(const std::string& text)
{
  try {
    const std::size_t cross = text.find('x');
    if (cross == std::string::npos) throw InputError("it has no 'x'");
    std::string width = text.substr(0, cross);
    const std::string height = text.substr(cross + 1);
    const auto is_letter = [](char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; };
    if (std::none_of(width.begin(), width.end(), is_letter))
      width += std::string(std::find_if(height.begin(), height.end(), is_letter), height.end());
    const std::array<double, 2> size{parse_length(width), parse_length(height)};
    if (!(size[0] > 0 && size[1] > 0)) throw InputError("it must be above 0 both ways");
    return size;
  } catch (const InputError& error) {
    throw InputError(fmt::format("--sheet: '{}' is no sheet size ({}): write it as 600x400mm", text, error.what()));
  }
}

void write_surfaces(const std::string& out, const PanelLayout& layout)
{
  const std::vector<int> panels = panel_of_triangles(layout);
  const Field ids{"panel [1]",
                  Eigen::Map<const Eigen::VectorXi>(panels.data(), layout.triangle_count()).cast<double>()};
  write_vtp(out + "/target.vtp", {layout.nodes, node_triangles(layout)}, {{}, {ids}});
  Positions flat = Positions::Zero(layout.vertex_count(), 3);
  flat.leftCols(2) = layout.flat;
  // Side by side, as they lie around their origins.
  double x = 0;
  for (const Panel& panel : layout.panels) {
    auto rows = flat.middleRows(panel.first_vertex, panel.vertex_count);
    rows.col(0).array() += x - rows.col(0).minCoeff();
    x = rows.col(0).maxCoeff() * 1.02;
  }
  write_vtp(out + "/flat.vtp", {flat, layout.triangles}, {{}, {ids}});
}

void write_panel_metrics(const std::string& out, const PanelLayout& layout, std::size_t sheets, double time)
{
  double mean_mismatch = 0, max_mismatch = 0, stretch = 0, area = 0, max_stretch = 0;
  for (const Seam& seam : layout.seams) {
    const std::vector<double> lengths = side_lengths(layout, seam);
    const double mismatch = 2 * std::abs(lengths[0] - lengths[1]) / (lengths[0] + lengths[1]);
    mean_mismatch += mismatch / static_cast<double>(layout.seams.size());
    max_mismatch = std::max(max_mismatch, mismatch);
  }
  for (std::size_t i = 0; i < layout.panels.size(); ++i) {
    const Distortion of_panel = distortion(layout, static_cast<int>(i));
    const TriangleMesh mesh = panel_mesh(layout, static_cast<int>(i));
    const double panel_area = surface_area(flatten(mesh.vertices), mesh.triangles);
    area += panel_area;
    stretch += panel_area * of_panel.mean;
    max_stretch = std::max(max_stretch, of_panel.max);
  }
  const auto walls =
      std::count_if(layout.panels.begin(), layout.panels.end(), [](const Panel& p) { return p.is_wall; });
  write_metrics(out, {{"panels", double(layout.panels.size())},
                      {"inner_panels", double(walls)},
                      {"triangles", double(layout.triangle_count())},
                      {"smallest_quality", smallest_quality(flatten(layout.nodes), node_triangles(layout))},
                      {"seams", double(layout.seams.size())},
                      {"seam_mismatch_mean", mean_mismatch},
                      {"seam_mismatch_max", max_mismatch},
                      {"flattening_stretch_mean", stretch / area},
                      {"flattening_stretch_max", max_stretch},
                      {"area", area, "m^2"},
                      {"sheets", double(sheets)},
                      {"time", time, "s"}});
}

ExitCode run(const PanelsInput& input)
{
  const std::array<double, 2> sheet = parse_sheet(input.sheet);
  const FlatteningOptions flattening{flattening_method(input.flattening)};
  require_writable(input.out);
  const SeamPlan plan = read_seam_file(input.seams);
  const TriangleMesh target = read_mesh(input.mesh);
  require_closed_surface(target, input.mesh);
  const double unit = metres_per_unit(target, input.mesh, input.size);

  Progress progress;
  progress.step("cutting along the seams");
  // In the file's own unit, so that messages speak of the seam file's coordinates.
  PanelLayout layout = cut_into_panels(input.vertices > 0 ? remesh_to_vertex_count(target, input.vertices) : target,
                                       Geodesics(target), plan);
  layout.nodes *= unit;
  progress.step(fmt::format("flattening {} panels", layout.panels.size()));
  flatten_panels(layout, flattening);
  progress.step("laying them on sheets");
  PatternOptions pattern;
  pattern.allowance = input.allowance.value_or(pattern.allowance);
  pattern.notch_spacing = input.notches.value_or(pattern.notch_spacing);
  NestingOptions nesting;
  nesting.sheet_width = sheet[0];
  nesting.sheet_height = sheet[1];
  nesting.keeps_grain = input.keeps_grain;
  const std::vector<PatternPiece> sheets = nested(pattern_pieces(layout, pattern), nesting);
  progress.end();

  write_pattern_svg(input.out + "/panels.svg", sheets);
  write_pattern_dxf(input.out + "/panels.dxf", sheets);
  write_pattern_pdf(input.out + "/panels.pdf", sheets);
  write_text(input.out + "/seams.csv", seam_table(layout));
  write_surfaces(input.out, layout);
  write_panel_metrics(input.out, layout, sheets.size(), progress.elapsed_s());
  spdlog::info("{} panels on {} sheets of {}; the results are in {}", layout.panels.size(), sheets.size(), input.sheet,
               input.out);
  return Success;
}

}  // namespace

void add_panels_command(CLI::App& program, ExitCode& exit_code)
{
  CLI::App* command = program.add_subcommand("panels", "Cut a target into flat panels along its seams");
  auto input = std::make_shared<PanelsInput>();
  command->add_option("TARGET", input->mesh, "Closed surface: OBJ, OFF, PLY or STL")->required();
  command->add_option("--seams", input->seams, "Where the seams run: a JSON file, see below")
      ->required()
      ->type_name("FILE");
  add_length(*command, "--size", input->size,
             "Largest distance between two vertices, for example 40cm;\nwithout it the file's numbers are millimetres");
  command->add_option("--vertices", input->vertices, "Vertices of the panels' mesh [those of the target]")
      ->check(CLI::Range(12, 1'000'000));
  command->add_option("--flattening", input->flattening, "symmetric-dirichlet [default] or boundary, the thesis' own")
      ->type_name("NAME");
  add_length(*command, "--allowance", input->allowance, "Seam allowance [8mm]");
  add_length(*command, "--notches", input->notches, "Distance between notches along a seam [50mm]");
  command->add_option("--sheet", input->sheet, "Size of a sheet of material [600x400mm]")->type_name("WIDTHxHEIGHT");
  command->add_flag("--grain", input->keeps_grain, "Keep the grain: panels are turned by half turns only");
  command->add_option("--out", input->out, "Folder for the results; created if need be")->required()->type_name("DIR");
  command->footer(examples);
  command->callback([input, &exit_code] { exit_code = run(*input); });
}

}  // namespace softform::cli
