#include "panels_input.hpp"

#include <algorithm>
#include <array>
#include <cctype>

#include <fmt/format.h>

#include "files.hpp"
#include "options.hpp"
#include "softform/core/error.hpp"
#include "softform/core/units.hpp"
#include "softform/inflatables/cut_panels.hpp"
#include "softform/inflatables/flatten.hpp"
#include "softform/io/mesh_io.hpp"
#include "softform/mesh/check.hpp"
#include "softform/mesh/remesh.hpp"

namespace softform::cli {
namespace {

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

}  // namespace

const char* const seam_file_help =
    R"(The seam file's coordinates are those of the target's file:
  {"seams": [{"name": "neck", "closed": true, "points": [[0, 1, 2], [1, 1, 2], [0, 1, 3]]},
             {"name": "back", "points": [{"on": "neck", "at": 0.5}, [0, 0, 3], [0, -1, 2]]}],
   "walls": [{"name": "brace", "between": ["neck", "back"]}],
   "panels": [{"name": "head", "inside": [0, 2, 2]}]}
A point [x, y, z] is projected to the target; {"on": SEAM, "at": FRACTION} or {"on": SEAM, "near": [x, y, z]} lies on an
earlier seam. "weight" says how much a seam has to stay in its place (1). Walls and panels' names may be left out.
)";

void add_panels_input(CLI::App& command, PanelsInput& input)
{
  command.add_option("TARGET", input.mesh, "Closed surface: OBJ, OFF, PLY or STL")->required();
  command.add_option("--seams", input.seams, "Where the seams run: a JSON file, see below")
      ->required()
      ->type_name("FILE");
  add_length(command, "--size", input.size,
             "Largest distance between two vertices, for example 40cm;\nwithout it the file's numbers are millimetres");
  command.add_option("--vertices", input.vertices, "Vertices of the panels' mesh [those of the target]")
      ->check(CLI::Range(12, 1'000'000));
  command.add_option("--flattening", input.flattening, "symmetric-dirichlet [default] or boundary, the thesis' own")
      ->type_name("NAME");
  add_length(command, "--allowance", input.allowance, "Seam allowance [8mm]");
  add_length(command, "--notches", input.notches, "Distance between notches along a seam [50mm]");
  command.add_option("--sheet", input.sheet, "Size of a sheet of material [600x400mm]")->type_name("WIDTHxHEIGHT");
  command.add_flag("--grain", input.keeps_grain, "Keep the grain: panels are turned by half turns only");
  command.add_option("--out", input.out, "Folder for the results; created if need be")->required()->type_name("DIR");
}

SheetSettings sheet_settings(const PanelsInput& input)
{
  const std::array<double, 2> sheet = parse_sheet(input.sheet);
  SheetSettings settings;
  settings.pieces.allowance = input.allowance.value_or(settings.pieces.allowance);
  settings.pieces.notch_spacing = input.notches.value_or(settings.pieces.notch_spacing);
  settings.nesting.sheet_width = sheet[0];
  settings.nesting.sheet_height = sheet[1];
  settings.nesting.keeps_grain = input.keeps_grain;
  return settings;
}

void require_fit(const PanelLayout& layout, const SheetSettings& settings)
{
  for (const PatternPiece& piece : pattern_pieces(layout, settings.pieces)) nested({piece}, settings.nesting);
}

std::vector<PatternPiece> laid_on_sheets(const PanelLayout& layout, const SheetSettings& settings)
{
  return nested(pattern_pieces(layout, settings.pieces), settings.nesting);
}

CutTarget cut_target(const PanelsInput& input, Progress& progress)
{
  const FlatteningOptions flattening{flattening_method(input.flattening)};
  const SeamPlan plan = read_seam_file(input.seams);
  CutTarget cut{read_mesh(input.mesh), {}};
  require_closed_surface(cut.target, input.mesh);
  const double unit = metres_per_unit(cut.target, input.mesh, input.size);

  progress.step("cutting along the seams");
  // In the file's own unit, so that messages speak of the seam file's coordinates.
  cut.layout = cut_into_panels(input.vertices > 0 ? remesh_to_vertex_count(cut.target, input.vertices) : cut.target,
                               Geodesics(cut.target), plan);
  cut.target.vertices *= unit;
  cut.layout.nodes *= unit;
  progress.step(fmt::format("flattening {} panels", cut.layout.panels.size()));
  flatten_panels(cut.layout, flattening);
  return cut;
}

}  // namespace softform::cli
