// Purpose: four question marks from one straight bar that is held at its end caps alone (thesis section 5.5 and figure
// 5.3): a layout of a soft and a 1000 times stiffer material for each, by (5.16)-(5.19).
// Claim: with the caps in the same place, the uniform bar misses its target by millimetres, and the bar of two
// materials follows it to a fraction of a millimetre; every element is one of the two materials. Targets are bent
// geometrically, by `question_marks()`, not simulated. Each pose is followed from rest, the caps moved as the bar bends
// (reachability): its smallest eigenvalue stays positive and the end is the optimised pose.

#include <ctime>

#include <fmt/format.h>

#include "softform/characters/bar_character.hpp"
#include "softform/characters/pose_error.hpp"
#include "softform/experiment/experiment.hpp"
#include "softform/experiment/run.hpp"

namespace {

using namespace softform;

void report_trace(Run& run, const std::string& name, const PoseTrace& trace, const Vec& pose)
{
  double smallest = trace.steps.front().relative_eigenvalue;
  CsvTable& table =
      run.series("trace_" + name, {{"parameter", "1"}, {"smallest eigenvalue", "N/m"}, {"iterations", "1"}});
  for (const TraceStep& step : trace.steps) {
    table.add_row({step.parameter, step.smallest_eigenvalue, double(step.iterations)});
    // NaN, the mark of an unstable state, must not be lost.
    if (!(step.relative_eigenvalue >= smallest)) smallest = step.relative_eigenvalue;
  }
  run.metric("reached_" + name, trace.is_reached ? 1 : 0, "1");
  run.metric("smallest_eigenvalue_" + name, smallest, "1");
  run.metric("trace_difference_" + name, (trace.x - pose).lpNorm<Eigen::Infinity>(), "m");
}

void design_mark(Run& run, const QuestionMark& mark)
{
  BarOptions options;
  if (!run.is_paper()) options.cells = {24, 4, 1};
  const BarCharacter bar(options, mark.bends);
  const Vec target = bar.pose(1), uniform = Vec::Constant(bar.body().element_count(), options.first_density);
  const auto metric = [&](const char* name, double value, const char* unit) {
    run.metric(fmt::format("{}_{}", name, mark.name), value, unit);
  };
  // 1. The uniform bar, posed from rest.
  run.step(mark.name);
  const PoseTrace uniform_trace = bar.trace(uniform);
  const PoseError before = pose_error<3>(uniform_trace.x, target);

  // 2. The layout.
  const std::clock_t cpu_start = std::clock();
  MaterialLayout<3> layout;
  run.time(mark.name, [&] {
    layout = bar.optimize(uniform_trace.x, [&](const LayoutProgress& progress) {
      run.progress(describe(progress));
      return true;
    });
  });
  const double cpu_s = double(std::clock() - cpu_start) / CLOCKS_PER_SEC;
  const Vec& densities = layout.state.rho;
  const Vec& pose = layout.state.x.at(0);
  const PoseError after = pose_error<3>(pose, target);

  // 3. The way there.
  const PoseTrace trace = bar.trace(densities);
  report_trace(run, mark.name, trace, pose);

  // 4. Errors, crispness, pictures.
  metric("max_error", after.max, "m");
  metric("mean_error", after.mean, "m");
  metric("uniform_max_error", before.max, "m");
  metric("uniform_mean_error", before.mean, "m");
  metric("improvement", before.mean / after.mean, "1");
  metric("grey", densities.cwiseMin((1 - densities.array()).matrix()).maxCoeff(), "1");
  metric("stiff_fraction", densities.mean(), "1");
  metric("turn", bar.turn(), "rad");
  metric("refused_layouts", layout.refused_moves, "1");
  metric("flips", layout.flips, "1");
  metric("cpu", cpu_s, "s");
  bar.write(run.path(mark.name + "_rest"), bar.mesh().positions, densities);
  bar.write(run.path(mark.name + "_target"), target, densities);
  bar.write(run.path(mark.name + "_uniform"), uniform_trace.x, uniform);
  bar.write(run.path(mark.name + "_optimised"), pose, densities);
}

}  // namespace

int main(int argc, char** argv)
{
  return softform::run_experiment(argc, argv,
                                  {"fig_5_3",
                                   "5.5",
                                   "One straight bar, posed at its end caps alone, takes four question marks when two "
                                   "materials are laid out in it.",
                                   {0.2, 4}},
                                  [](Run& run) {
                                    for (const QuestionMark& mark : question_marks()) design_mark(run, mark);
                                  });
}
