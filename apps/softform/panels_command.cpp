// softform panels: the flat panels between the seams of a target, to be cut (thesis, sections 6.4.2 and 6.6.2).
#include <algorithm>
#include <memory>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "commands.hpp"
#include "files.hpp"
#include "panels_input.hpp"
#include "pattern_results.hpp"
#include "softform/inflatables/flatten.hpp"
#include "softform/io/vtk_io.hpp"
#include "softform/mesh/relax.hpp"

namespace softform::cli {
namespace {

constexpr const char* examples = R"(Example:
  softform panels bear.off --seams bear.json --size 40cm --allowance 8mm --sheet 600x400mm --out bear
The target is cut along its seams and each panel is flattened; how they deform under pressure is not looked at: that is
what softform inflatable does.
)";

constexpr const char* results = R"(Writes into DIR:
  panels.svg, .dxf   all sheets in millimetres, a layer each for cut, seam, notches, labels and grain
  panels.pdf         the same at true scale on tiled A4
  seams.csv          lengths of every seam on both its sides, and their mismatch
  target.vtp         the target with its panels, in metres for ParaView; flat.vtp the flat panels
  metrics.csv        what came out (metric,value,unit; SI))";

void write_panel_metrics(const std::string& out, const PanelLayout& layout, std::size_t sheets, double time)
{
  double stretch = 0, area = 0, max_stretch = 0;
  for (std::size_t i = 0; i < layout.panels.size(); ++i) {
    const Distortion of_panel = distortion(layout, static_cast<int>(i));
    const TriangleMesh mesh = panel_mesh(layout, static_cast<int>(i));
    const double panel_area = surface_area(flatten(mesh.vertices), mesh.triangles);
    area += panel_area;
    stretch += panel_area * of_panel.mean;
    max_stretch = std::max(max_stretch, of_panel.max);
  }
  const SeamMismatch mismatch = seam_mismatch(layout);
  write_metrics(out, {{"panels", double(layout.panels.size())},
                      {"inner_panels", double(wall_count(layout))},
                      {"triangles", double(layout.triangle_count())},
                      {"smallest_quality", smallest_quality(flatten(layout.nodes), node_triangles(layout))},
                      {"seams", double(layout.seams.size())},
                      {"seam_mismatch_mean", mismatch.mean},
                      {"seam_mismatch_max", mismatch.max},
                      {"flattening_stretch_mean", stretch / area},
                      {"flattening_stretch_max", max_stretch},
                      {"area", area, "m^2"},
                      {"sheets", double(sheets)},
                      {"time", time, "s"}});
}

ExitCode run(const PanelsInput& input)
{
  const SheetSettings settings = sheet_settings(input);
  require_writable(input.out);
  Progress progress;
  const PanelLayout layout = cut_target(input, progress).layout;
  progress.step("laying them on sheets");
  const std::vector<PatternPiece> sheets = laid_on_sheets(layout, settings);
  progress.end();

  write_pattern(input.out, layout, sheets);
  write_vtp(input.out + "/target.vtp", {layout.nodes, node_triangles(layout)}, {{}, {panel_field(layout)}});
  write_flat_panels(input.out, layout);
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
  add_panels_input(*command, *input);
  command->footer(std::string(examples) + seam_file_help + results);
  command->callback([input, &exit_code] { exit_code = run(*input); });
}

}  // namespace softform::cli
