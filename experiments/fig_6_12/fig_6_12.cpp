// Purpose: pattern optimisation of whole models (thesis 6.6, 6.7, figure 6.12): target, seams, what the flattened
// panels inflate into as they are, and after the optimisation (6.16) with the objectives (6.17) to (6.21) and
// remeshing. Claim: the optimised balloon is far closer to the target, and both sides of every seam are equally long.

#include "inflatable_designs.hpp"
#include "softform/experiment/experiment.hpp"
#include "softform/io/vtk_io.hpp"

namespace {

using namespace softform;
using namespace softform::experiments;

void design_models(Run& run)
{
  for (const std::string name : {"sphere", "teddy"}) {
    // 1. The target, cut along its seams.
    run.step("cutting the " + name);
    const InflatableModel model = load_inflatable(run, name);
    run.metric("panels_" + name, double(model.layout.panels.size()), "1");
    run.metric("triangles_" + name, model.layout.triangle_count(), "1");

    // 2. Its panels, flattened, inflated and optimised.
    run.step("designing the " + name);
    const InflatableDesign design = design_inflatable(run, model);
    report_design(run, model, design, "_" + name);

    // 3. To be drawn.
    write_inflated(run, name + "_target.vtp", {model.layout, flatten(model.layout.nodes)}, model.target);
    write_inflated(run, name + "_unoptimised.vtp", design.unoptimised, model.target);
    write_inflated(run, name + "_optimised.vtp", design.optimum.panels, model.target);
    write_flat(run, name + "_panels.vtp", design.optimum.panels.layout);
  }
}

}  // namespace

int main(int argc, char** argv)
{
  return run_experiment(
      argc, argv,
      {"fig_6_12", "6.7", "Optimised panels inflate far closer to the target, with seams that fit.", {0.5, 2}},
      design_models);
}
