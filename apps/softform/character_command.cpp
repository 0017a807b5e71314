// softform character: actuators, their places and two materials for a character's poses, and its fabrication (thesis,
// chapter 5).
#include <filesystem>
#include <memory>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include "commands.hpp"
#include "files.hpp"
#include "progress.hpp"
#include "softform/characters/character_file.hpp"
#include "softform/characters/fabrication.hpp"
#include "softform/core/error.hpp"
#include "softform/core/interrupt.hpp"
#include "softform/io/text_file.hpp"

namespace softform::cli {
namespace {

constexpr const char* examples = R"(Examples:
  softform character docs/examples/palm.json --out palm       a palm with four pins and stiff parts in its leaves
  softform character docs/examples/tower.json --out tower     a tower danced by strings over a ring
  softform character docs/examples/bar.json --out bar         a bar that becomes a question mark between two clamps
  softform character CONFIG.json --check                      reads everything, and says what it would do
The stages: actuators (how many, by forces that are asked to be few), places (they slide along the boundary), materials
(every element soft or stiff). Poses are then traced from rest: one that is reached only with a snap is said to be so.
Writes into DIR, all of it also when interrupted, of the stages that there are:
  report.txt                       how every stage ended, in words: read this first
  metrics.csv                      metric,value,unit; SI: max_error_<stage>_<pose>, mean_error_<stage>_<pose>, actuators,
                                   grey_elements, negative_eigenvalues, failed_equilibria, time and so on
  poses.csv                        the same as a table of stages and poses
  <stage>_<pose>.vtu               every stage and pose for ParaView, in metres; rest.vtu, target_<pose>.vtu
  soft.stl, stiff.stl, print.3mf   closed surfaces of both materials, in millimetres, in place
  islands.csv                      connected regions: what is a part to be printed, and what is too small
  drill_<pose>.svg, drill.csv      for pins: plates at true scale with the holes, measured from a corner
  strings.csv                      for strings: tensions, lengths, and how far each is drawn from pose to pose;
                                   drill_ring.svg has the pulleys)";

struct CharacterInput {
  std::string file, out;
  bool only_checks = false;
};

template <int dim>
ExitCode conclude(const CharacterDesign<dim>& design, const std::string& out)
{
  const CharacterStage<dim>& last = design.stages.back();
  if (last.report.termination == Termination::Interrupted) {
    spdlog::warn("interrupted in stage '{}': what there is so far is in {}", design.names.back(), out);
    return Interrupted;
  }
  if (!last.is_sound() || !last.report.converged()) {
    spdlog::error("stage '{}': {}: {}; what was computed is in {}", design.names.back(),
                  last.is_sound() ? to_string(last.report.termination) : "not every pose is a stable equilibrium",
                  last.report.message, out);
    return NotReached;
  }
  for (const PoseTrace& trace : last.traces)
    if (!trace.is_reached) spdlog::warn("a pose is not reached from rest without a snap: see {}/report.txt", out);
  spdlog::info("mean error {:.3f} mm, largest {:.3f} mm on the average over the poses; the results are in {}",
               1e3 * last.mean_error(), 1e3 * last.mean_max_error(), out);
  return Success;
}

template <int dim>
ExitCode run(const CharacterTask& task, const std::string& out)
{
  catch_interrupts();
  Progress progress;
  const CharacterDesign<dim> design = design_character<dim>(task, [&](const PipelineProgress& now) {
    progress.step(fmt::format("stage {}: {}", now.stage, now.text));
    return !interrupted();
  });
  progress.step("surfaces to print");
  const Fabrication made = fabricate<dim>(out, task, design);
  progress.end();
  write_stages<dim>(out, task, design);
  write_text(out + "/poses.csv", pose_table<dim>(task, design));
  std::string report = design_report<dim>(task, design) + "\nFabrication\n";
  for (const std::string& note : made.notes) report += fmt::format("  {}\n", note);
  write_text(out + "/report.txt", report);
  std::vector<Metric> metrics = design_metrics<dim>(task, design);
  for (const PrintedMaterial& material : made.print.materials)
    metrics.push_back({fmt::format("volume_{}", to_string(material.material)), material.volume, "m^3"});
  metrics.push_back({"islands", double(made.print.islands.size())});
  metrics.push_back({"total_time", progress.elapsed_s(), "s"});
  write_metrics(out, metrics);
  return conclude<dim>(design, out);
}

void describe(const CharacterTask& task)
{
  std::visit(
      [&](const auto& body) {
        spdlog::info("{}: {} elements, {} vertices, poses {}; stages {}", task.source, body.rest.element_count(),
                     body.rest.vertex_count(), fmt::join(body.names, ", "), fmt::join(task.stages, ", "));
      },
      task.body);
}

}  // namespace

void add_character_command(CLI::App& program, ExitCode& exit_code)
{
  CLI::App* command =
      program.add_subcommand("character", "Design actuators and two materials that bring a body into its poses");
  auto input = std::make_shared<CharacterInput>();
  command->add_option("CONFIG", input->file, "What is to be designed: a JSON file, see below")->required();
  CLI::Option* out = command->add_option("--out", input->out, "Folder for the results; created if need be");
  out->type_name("DIR");
  command->add_flag("--check", input->only_checks, "Only read and check the file and all that it names")->excludes(out);
  command->footer(std::string(examples) + "\n\n" + character_file_help);
  command->callback([input, &exit_code] {
    if (input->out.empty() && !input->only_checks)
      throw InputError("--out is missing: name a folder for the results, or ask for --check");
    if (!input->only_checks) require_writable(input->out);
    const CharacterTask task = read_character_task(input->file);
    describe(task);
    if (input->only_checks) {
      exit_code = Success;
      return;
    }
    exit_code = task.is_planar() ? run<2>(task, input->out) : run<3>(task, input->out);
  });
}

}  // namespace softform::cli
