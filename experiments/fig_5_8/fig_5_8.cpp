// Purpose: the question mark by end caps (thesis section 5.6, figure 5.8 left, and the rows of tables 5.1 and 5.2): the
// same caps on a uniform bar and on one of two materials, whose layout is found from two different starts.
// Claim: the layout brings the bar to its target where the uniform one cannot come, and what it reaches does not depend
// on the start. The figure's other half, Grampolo, is not here.

#include <ctime>

#include "softform/characters/bar_character.hpp"
#include "softform/characters/pose_error.hpp"
#include "softform/experiment/experiment.hpp"
#include "softform/experiment/run.hpp"

namespace {

using namespace softform;

// The optimised bar from a uniform density; its mean error [m].
double design_from(Run& run, BarOptions options, double first_density, const std::string& name)
{
  // 1. The uniform bar, posed from rest.
  run.step("from density " + name);
  options.first_density = first_density;
  const BarCharacter bar(options, question_marks().front().bends);
  const Vec target = bar.pose(1), uniform = Vec::Constant(bar.body().element_count(), first_density);
  const PoseTrace posed = bar.trace(uniform);
  if (name == "first") {
    const PoseError before = pose_error<3>(posed.x, target);
    run.metric("uniform_max_error", before.max, "m");
    run.metric("uniform_mean_error", before.mean, "m");
    run.metric("elements", bar.body().element_count(), "1");
    bar.write(run.path("target"), target, uniform);
    bar.write(run.path("uniform"), posed.x, uniform);
  }

  // 2. The layout.
  const std::clock_t cpu_start = std::clock();
  MaterialLayout<3> layout;
  run.time(name, [&] {
    layout = bar.optimize(posed.x, [&](const LayoutProgress& progress) {
      run.progress(describe(progress));
      return true;
    });
  });
  run.metric("cpu_" + name, double(std::clock() - cpu_start) / CLOCKS_PER_SEC, "s");
  const Vec& densities = layout.state.rho;
  const PoseError after = pose_error<3>(layout.state.x.at(0), target);
  run.metric("max_error_" + name, after.max, "m");
  run.metric("mean_error_" + name, after.mean, "m");
  run.metric("grey_" + name, densities.cwiseMin((1 - densities.array()).matrix()).maxCoeff(), "1");
  run.metric("stiff_fraction_" + name, densities.mean(), "1");
  run.metric("refused_layouts_" + name, layout.refused_moves, "1");

  // 3. From rest.
  const PoseTrace trace = bar.trace(densities);
  run.metric("reached_" + name, trace.is_reached ? 1 : 0, "1");
  run.metric("trace_difference_" + name, (trace.x - layout.state.x.at(0)).lpNorm<Eigen::Infinity>(), "m");
  bar.write(run.path("optimised_" + name), layout.state.x.at(0), densities);
  bar.write(run.path("rest_" + name), bar.mesh().positions, densities);
  return after.mean;
}

void compare_starts(Run& run)
{
  BarOptions options;
  if (!run.is_paper()) options.cells = {24, 4, 1};
  const double first = design_from(run, options, 0.5, "first");
  const double second = design_from(run, options, 0.3, "second");
  run.metric("second_over_first", second / first, "1");
}

}  // namespace

int main(int argc, char** argv)
{
  return softform::run_experiment(
      argc, argv, {"fig_5_8", "5.6", "Two materials bring a bar to its question mark by its end caps alone.", {0.1, 2}},
      compare_starts);
}
