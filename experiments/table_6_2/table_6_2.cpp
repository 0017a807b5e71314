// Purpose: the models of chapter 6 in numbers (thesis table 6.2): elements, panels, inner panels.
// Claim: our sphere and teddy are cut into as many panels as the thesis'.

#include <algorithm>

#include "inflatable_designs.hpp"
#include "softform/experiment/experiment.hpp"

namespace {

using namespace softform;
using namespace softform::experiments;

void count_panels(Run& run)
{
  for (const std::string name : {"sphere", "teddy"}) {
    run.step("cutting the " + name);
    const PanelLayout layout = load_inflatable(run, name).layout;
    run.metric("elements_" + name, layout.triangle_count(), "1");
    run.metric("panels_" + name, double(layout.panels.size()), "1");
    run.metric(
        "inner_panels_" + name,
        double(std::count_if(layout.panels.begin(), layout.panels.end(), [](const Panel& p) { return p.is_wall; })),
        "1");
  }
}

}  // namespace

int main(int argc, char** argv)
{
  return run_experiment(argc, argv,
                        {"table_6_2", "6.7", "Sphere and teddy have as many panels as in the thesis.", {0.1, 0.2}},
                        count_panels);
}
