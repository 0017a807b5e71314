// Purpose: a sphere from three panels, from a deliberately bad first guess (thesis 6.6.2, figure 6.10): two panels far
// too large, one too small, so that the sides of their seams differ. Seams are free to slide. Claim: the optimisation
// still finds panels that inflate to the sphere, and they are alike.

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "inflatable_designs.hpp"
#include "softform/experiment/experiment.hpp"
#include "softform/inflatables/flatten.hpp"

namespace {

using namespace softform;
using namespace softform::experiments;

/// Length and area of a flat panel's outline: equal for congruent panels.
struct PanelMeasures {
  double area = 0, perimeter = 0;
};

PanelMeasures measures(const PanelLayout& layout, int panel)
{
  PanelMeasures result;
  const Panel& p = layout.panels[std::size_t(panel)];
  result.area = flat_areas(layout).segment(p.first_triangle, p.triangle_count).sum();
  for (const std::vector<int>& loop : boundary_loops(layout, panel))
    for (std::size_t i = 0; i < loop.size(); ++i)
      result.perimeter += (layout.flat.row(loop[i]) - layout.flat.row(loop[(i + 1) % loop.size()])).norm();
  return result;
}

/// The largest relative difference between two panels' areas or perimeters.
double difference(const PanelLayout& layout)
{
  double worst = 0;
  const int count = static_cast<int>(layout.panels.size());
  for (int i = 0; i < count; ++i)
    for (int j = 0; j < i; ++j) {
      const PanelMeasures a = measures(layout, i), b = measures(layout, j);
      worst = std::max({worst, std::abs(a.area - b.area) / std::max(a.area, b.area),
                        std::abs(a.perimeter - b.perimeter) / std::max(a.perimeter, b.perimeter)});
    }
  return worst;
}

// The weight of (6.20) that holds seams straight.
constexpr double firm_weight = 30;

void design_sphere(Run& run)
{
  // 1. The lunes, flat, two of them 1.3 times too large and one at .8.
  run.step("a bad first guess");
  InflatableModel model = load_inflatable(run, "sphere");
  flatten_panels(model.layout);
  const double factors[] = {1.3, 1.3, 0.8};
  for (std::size_t i = 0; i < 3; ++i) {
    const Panel& panel = model.layout.panels[i];
    model.layout.flat.middleRows(panel.first_vertex, panel.vertex_count) *= factors[i];
  }
  run.metric("first_difference", difference(model.layout), "1");
  run.metric("first_seam_mismatch_max", seam_mismatch(model.layout).max, "1");

  // 2. Optimised from there with seams that hardly bend (6.20), so that the panels become lunes again; then they are
  // let go in stages, to the weight of the other experiments, and slide.
  PatternWeights weights;
  const InflatedPanels first = inflated_panels(model.layout, design_film());
  InflatableDesign firm, design;
  design.optimum.panels = first;
  for (const double weight : {firm_weight, 10.0, 3.0, 1.0, 0.3, 0.1}) {
    run.step(fmt::format("seams at a weight of {}", weight));
    weights.boundary = weight;
    design = design_inflatable(run, model, design.optimum.panels, weights);
    design.unoptimised = first;
    run.metric(fmt::format("panel_difference_{}", weight), difference(design.optimum.panels.layout), "1");
    if (weight == firm_weight) firm = design;
  }
  report_design(run, model, firm, "_firm");
  report_design(run, model, design, "");

  // 3. To be drawn.
  write_inflated(run, "first.vtp", firm.unoptimised, model.target);
  write_flat(run, "first_panels.vtp", model.layout);
  write_inflated(run, "firm.vtp", firm.optimum.panels, model.target);
  write_flat(run, "firm_panels.vtp", firm.optimum.panels.layout);
  write_inflated(run, "optimised.vtp", design.optimum.panels, model.target);
  write_flat(run, "optimised_panels.vtp", design.optimum.panels.layout);
}

}  // namespace

int main(int argc, char** argv)
{
  return run_experiment(
      argc, argv,
      {"fig_6_10", "6.6.2", "Three panels of a sphere are found from a bad first guess, and are alike.", {0.2, 0.5}},
      design_sphere);
}
