// Purpose: how long pattern optimisation takes (thesis table 6.1): iterations, remeshings, times to a preview, within 5
// % of the size of the final shape, and to the end. Claim: a preview within seconds, the optimum within minutes.

#include "inflatable_designs.hpp"
#include "softform/experiment/experiment.hpp"

namespace {

using namespace softform;
using namespace softform::experiments;

void time_designs(Run& run)
{
  for (const std::string name : {"sphere", "teddy"}) {
    run.step("designing the " + name);
    const InflatableModel model = load_inflatable(run, name);
    const double cpu = Run::cpu_s();
    InflatableDesign design;
    const double seconds = run.time(name, [&] { design = design_inflatable(run, model); });
    report_design(run, model, design, "_" + name);
    // Flattening and the first inflation come before the optimisation's own clock.
    const double before = seconds - design.optimum.report.trace.back().elapsed_s;
    run.metric("time_preview_" + name, before + design.preview.within(0.05 * model.target.size()), "s");
    run.metric("time_cpu_" + name, Run::cpu_s() - cpu, "s");
  }
}

}  // namespace

int main(int argc, char** argv)
{
  return run_experiment(
      argc, argv, {"table_6_1", "6.7", "Panels are optimised within a minute on two cores.", {0.5, 2}}, time_designs);
}
