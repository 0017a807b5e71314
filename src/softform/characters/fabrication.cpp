#include "softform/characters/fabrication.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "softform/io/text_file.hpp"

namespace softform {
namespace {

DrillPlan plates(const CharacterTask& task, const CharacterDesign<2>& design, std::size_t stage)
{
  const PosedMesh<2>& body = std::get<0>(task.body);
  const Pins& pins = design.pins[stage];
  std::vector<DrillPose> poses{{"rest", pins.places, body.rest.positions}};
  for (std::size_t i = 0; i < pins.positions.size(); ++i)
    poses.push_back({body.names[i], pins.positions[i], design.stages[stage].positions[i]});
  return drill_plan(std::move(poses), body.rest.elements, task.drill);
}

// The ties in the body at rest, and the pulleys on the ring around it.
DrillPlan ring_plates(const CharacterTask& task, const StringPlan& plan)
{
  const PosedMesh<2>& body = std::get<0>(task.body);
  DrillPose rest{"rest", {}, body.rest.positions}, ring{"ring", {}, body.rest.positions};
  for (const StringPlan::Line& line : plan.strings) {
    rest.holes.push_back(line.place);
    ring.holes.push_back(line.ring_point);
  }
  return drill_plan({rest, ring}, body.rest.elements, task.drill);
}

void write_plates(const std::filesystem::path& folder, const DrillPlan& plan)
{
  for (std::size_t i = 0; i < plan.poses.size(); ++i)
    write_drill_svg(folder / fmt::format("drill_{}.svg", plan.poses[i].name), plan, i);
  write_text(folder / "drill.csv", drill_table(plan));
}

constexpr int most_named = 10;  // of what is too small: there may be hundreds

std::vector<std::string> notes_on(const PrintedBody& print, double printable_size)
{
  std::vector<std::string> notes;
  for (const PrintedMaterial& material : print.materials) {
    const auto count = std::count_if(print.islands.begin(), print.islands.end(),
                                     [&](const Island& island) { return island.material == material.material; });
    notes.push_back(
        fmt::format("{}: {} islands, {:.4g} cm^3; {} vertices and {} edges where it touched itself were split",
                    to_string(material.material), count, 1e6 * material.volume, material.surface.split_vertices,
                    material.surface.split_edges));
    for (const std::string& problem : material.problems)
      notes.push_back(fmt::format("{}: NOT printable as it is: {}", to_string(material.material), problem));
  }
  int unprintable = 0;
  for (std::size_t i = 0; i < print.islands.size(); ++i) {
    const Island& island = print.islands[i];
    const Vec3 at = 1e3 * island.centre;
    const auto say = [&](const std::string& what) {
      notes.push_back(fmt::format("island {} ({}, at {:.1f}, {:.1f}, {:.1f} mm): {}", i + 1, to_string(island.material),
                                  at.x(), at.y(), at.z(), what));
    };
    if (!island.is_printable(printable_size) && ++unprintable <= most_named)
      say(fmt::format("too small to print: the largest ball inside measures {:.2f} mm, not {:.2f}",
                      1e3 * island.inscribed_diameter, 1e3 * printable_size));
    if (island.necks > 0)
      say(fmt::format("hangs together by necks narrower than {:.2f} mm, some {}", 1e3 * printable_size, island.necks));
  }
  if (unprintable > most_named)
    notes.push_back(fmt::format("{} islands more are too small to print: see islands.csv", unprintable - most_named));
  return notes;
}

}  // namespace

std::string string_table(const StringPlan& plan, const std::vector<std::string>& poses)
{
  std::string text = "pose,string,tension [N],length [mm],from_rest [mm],from_previous [mm]\n";
  for (std::size_t i = 0; i < poses.size(); ++i)
    for (std::size_t j = 0; j < plan.strings.size(); ++j) {
      const StringPlan::Line& line = plan.strings[j];
      const double rest = (line.ring_point - line.place).norm(), length = line.free_lengths[i];
      text += fmt::format("{},{},{:.4f},{:.3f},{:.3f},{:.3f}\n", poses[i], j + 1, line.tensions[i], 1e3 * length,
                          1e3 * (length - rest), 1e3 * (length - (i > 0 ? line.free_lengths[i - 1] : rest)));
    }
  return text;
}

template <int dim>
Fabrication fabricate(const std::filesystem::path& folder, const CharacterTask& task,
                      const CharacterDesign<dim>& design)
{
  const std::size_t stage = design.made_stage();
  const PosedMesh<dim>& body = std::get<PosedMesh<dim>>(task.body);
  Fabrication made;
  made.print = printed_body(body.rest, design.stages[stage].densities, task.print);
  write_printed_body(folder, made.print, dim == 2, task.print);
  made.notes = notes_on(made.print, task.print.printable_size);
  made.notes.insert(made.notes.begin(), fmt::format("made is what stage '{}' ended with", design.names[stage]));
  if (design.stages[stage].grey_elements > 0)
    made.notes.push_back(
        fmt::format("{} elements were neither soft nor stiff and are rounded: the print will NOT take "
                    "the poses as computed",
                    design.stages[stage].grey_elements));
  if constexpr (dim == 2) {
    if (!design.strings.empty()) write_text(folder / "strings.csv", string_table(design.strings[stage], body.names));
    if (!design.pins.empty() || !design.strings.empty()) {
      made.drill = design.pins.empty() ? ring_plates(task, design.strings[stage]) : plates(task, design, stage);
      write_plates(folder, made.drill);
      const std::vector<std::string> crowded = crowded_holes(made.drill);
      if (!crowded.empty())
        made.notes.push_back(fmt::format("holes closer than one and a half diameters: {}", fmt::join(crowded, "; ")));
    }
  }
  return made;
}

template Fabrication fabricate<2>(const std::filesystem::path&, const CharacterTask&, const CharacterDesign<2>&);
template Fabrication fabricate<3>(const std::filesystem::path&, const CharacterTask&, const CharacterDesign<3>&);

}  // namespace softform
