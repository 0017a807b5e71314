// softform mould: the positive mould of a balloon, ready to print (thesis 4.5.1).
#include <filesystem>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include "commands.hpp"
#include "files.hpp"
#include "nozzle_options.hpp"
#include "options.hpp"
#include "softform/balloons/mould.hpp"
#include "softform/core/error.hpp"
#include "softform/core/units.hpp"
#include "softform/io/mesh_io.hpp"
#include "softform/io/text_file.hpp"
#include "softform/io/threemf.hpp"
#include "softform/io/vtk_io.hpp"

namespace softform::cli {
namespace {

constexpr const char* examples = R"(Examples:
  softform mould bunny/rest.obj --nozzle 217 --nozzle-diameter 12mm --out bunny/mould
  softform mould rest.stl --nozzle bottom --wall 2mm --plate 60x60x5mm --feature 0.4mm --out mould
The rest shape stands on a tube, the nozzle's, and the tube on a plate with four screw holes. softform balloon --nozzle
says which vertex its nozzle has. Lengths take um, mm, cm, m, in; the mesh's numbers are millimetres.
Writes into DIR:
  mould.stl, mould.3mf  the solid to print, in millimetres; checked: closed, outwards, without self-intersections
  mould.vtp             for ParaView, in metres: the material's thickness and the gap before it, along the normals,
                        and where rubber would be trapped: the mould is in the way of every direction of --pull
  report.json           what was checked and measured, in words for people and programs
  metrics.csv           the same numbers (metric,value,unit; SI))";

struct MouldInput {
  std::string mesh, out, wall = "solid", plate = "40x40x4mm";
  NozzleInput nozzle;
  std::optional<double> size, tube, screw, feature;
  std::vector<std::string> pulls;
};

// "40x40x4mm": the last side has the unit, the others may.
Vec3 parse_plate(const std::string& text)
{
  const auto unit = text.find_last_of("0123456789.");
  const std::string suffix = unit == std::string::npos ? "" : text.substr(unit + 1);
  Vec3 sides;
  std::size_t begin = 0;
  for (Eigen::Index k = 0; k < 3; ++k) {
    const std::size_t end = k < 2 ? text.find('x', begin) : text.size();
    if (end == std::string::npos) throw InputError(fmt::format("--plate: '{}' must look like 40x40x4mm", text));
    const std::string side = text.substr(begin, end - begin);
    const bool has_unit = !side.empty() && std::isalpha(static_cast<unsigned char>(side.back())) != 0;
    try {
      sides[k] = parse_length(has_unit ? side : side + suffix);
    } catch (const InputError& error) {
      throw InputError(fmt::format("--plate: {}", error.what()));
    }
    begin = end + 1;
  }
  return sides;
}

std::optional<double> parse_wall(const std::string& text)
{
  if (text == "solid") return std::nullopt;
  try {
    return parse_length(text);
  } catch (const InputError& error) {
    throw InputError(fmt::format("--wall: {}; or say solid", error.what()));
  }
}

MouldOptions mould_options(const MouldInput& input)
{
  MouldOptions options;
  options.wall = parse_wall(input.wall);
  options.plate = parse_plate(input.plate);
  options.tube_length = input.tube.value_or(options.tube_length);
  options.screw_diameter = input.screw.value_or(options.screw_diameter);
  return options;
}

void write_report(const std::string& out, const Mould& mould, const MouldInspection& found, double feature)
{
  const auto mm = [](double metres) { return 1e3 * metres; };
  const Vec3 where = mm(1) * found.thinnest;
  const bool is_printable = found.smallest_thickness >= feature && found.smallest_gap >= feature;
  const nlohmann::ordered_json report{
      {"closed", true},
      {"self_intersections", 0},
      {"triangles", mould.surface.triangle_count()},
      {"genus", mould.genus},
      {"volume_cm3", 1e6 * enclosed_volume(mould.surface)},
      {"cavities_left_solid_cm3", 1e6 * mould.closed_off},
      {"smallest_thickness_mm", mm(found.smallest_thickness)},
      {"thinnest_at_mm", {where.x(), where.y(), where.z()}},
      {"smallest_gap_mm", mm(found.smallest_gap)},
      {"printer_feature_mm", mm(feature)},
      {"printable", is_printable},
      {"trapped_area_fraction", found.trapped_fraction},
  };
  write_text(out + "/report.json", report.dump(2) + "\n");
  write_metrics(out, {{"volume", enclosed_volume(mould.surface), "m^3"},
                      {"cavities_left_solid", mould.closed_off, "m^3"},
                      {"genus", double(mould.genus), "1"},
                      {"smallest_thickness", found.smallest_thickness, "m"},
                      {"smallest_gap", found.smallest_gap, "m"},
                      {"thin_area_fraction", found.thin_fraction, "1"},
                      {"trapped_area_fraction", found.trapped_fraction, "1"}});
  fmt::print("volume {:.2f} cm3, {} triangles, closed, no self-intersections\n", 1e6 * enclosed_volume(mould.surface),
             mould.surface.triangle_count());
  fmt::print("smallest thickness {:.2f} mm at ({:.1f}, {:.1f}, {:.1f}) mm, smallest gap {:.2f} mm: {}\n",
             mm(found.smallest_thickness), where.x(), where.y(), where.z(), mm(found.smallest_gap),
             is_printable ? "the printer can do that" : "finer than the printer's smallest feature");
  fmt::print("rubber is trapped on {:.1f} % of the rest shape: see mould.vtp\n", 100 * found.trapped_fraction);
}

ExitCode run(const MouldInput& input)
{
  const MouldOptions options = mould_options(input);
  const auto placement = nozzle_placement(input.nozzle);
  const double feature = input.feature.value_or(0.5e-3);
  std::vector<Vec3> pulls;
  for (const std::string& pull : input.pulls) pulls.push_back(parse_direction("--pull", pull));
  require_writable(input.out);
  const TriangleMesh rest = read_closed_mesh(input.mesh, input.size);
  const Nozzle nozzle = place_nozzle(rest, placement.value());
  if (pulls.empty()) pulls = pull_directions(nozzle);

  const Mould mould = make_mould(rest, nozzle, options);
  const MouldInspection found = inspect_mould(mould.surface, rest, pulls, feature);
  TriangleMesh in_millimetres = mould.surface;
  in_millimetres.vertices *= 1e3;
  write_mesh(input.out + "/mould.stl", in_millimetres);
  write_3mf(input.out + "/mould.3mf", mould.surface);
  const Vec trapped =
      Eigen::Map<const Eigen::Matrix<char, Eigen::Dynamic, 1>>(found.trapped.data(), Eigen::Index(found.trapped.size()))
          .cast<double>();
  write_vtp(input.out + "/mould.vtp", mould.surface,
            {{}, {{"thickness [m]", found.thickness}, {"gap [m]", found.gap}, {"trapped [1]", trapped}}});
  write_report(input.out, mould, found, feature);
  if (mould.closed_off > 0)
    spdlog::info("{:.2f} cm3 of cavities that the tube does not reach are left solid", 1e6 * mould.closed_off);
  return Success;
}

}  // namespace

void add_mould_command(CLI::App& program, ExitCode& exit_code)
{
  CLI::App* command = program.add_subcommand("mould", "Make the mould of a balloon from its rest shape");
  auto input = std::make_shared<MouldInput>();
  command->add_option("REST", input->mesh, "The balloon's rest shape: OBJ, OFF, PLY or STL")->required();
  add_nozzle(*command, input->nozzle)->required();
  command->add_option("--wall", input->wall, "Thickness of a hollow mould's wall, or solid [solid]")
      ->type_name("LENGTH|solid");
  add_length(*command, "--tube", input->tube, "Length of the tube from nozzle to plate [20mm]");
  command->add_option("--plate", input->plate, "Sides of the plate [40x40x4mm]")->type_name("AxBxCmm");
  add_length(*command, "--screw", input->screw, "Diameter of the screw holes [4.5mm]");
  add_length(*command, "--feature", input->feature, "Smallest feature that the printer can make [0.5mm]");
  command
      ->add_option(
          "--pull", input->pulls,
          "A direction in which rubber can be taken off; may be repeated\n[away from the plate and sideways four ways]")
      ->type_name("DIRECTION")
      ->allow_extra_args(false);
  add_length(*command, "--size", input->size,
             "Largest distance between two vertices; without it the file's numbers are millimetres");
  command->add_option("--out", input->out, "Folder for the results; created if need be")->required()->type_name("DIR");
  command->footer(examples);
  command->callback([input, &exit_code] { exit_code = run(*input); });
}

}  // namespace softform::cli
