// Purpose: the times of table 4.1 (thesis section 4.6). All ten balloons are designed one after the other in one run,
// with the same options and the same rubber, and each is checked: a time counts only for a balloon that can be made.
// Claim: together they take at most a sixtieth of the thesis' 13 584 s, and each at most an eighth of its own row.
// A "static step" is one Newton iteration of an equilibrium, a "shape step" one linearisation, factorisation and solve
// of the optimiser; the thesis' t_stat is a whole equilibrium, its t_nwtn one step of its full-space Newton method.

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "softform/balloons/balloon_design.hpp"
#include "softform/core/statistics.hpp"
#include "softform/experiment/experiment.hpp"
#include "softform/experiment/run.hpp"
#include "softform/io/datasets.hpp"
#include "softform/io/text_file.hpp"
#include "softform/materials/material_file.hpp"
#include "softform/mesh/self_intersections.hpp"

namespace {

using namespace softform;

struct Row {
  const char* model;
  const char* dataset;
  int quick, paper;       // vertices; 0 where the quick run leaves the model out
  double t_stat, t_nwtn;  // of table 4.1 [s]
  double t_tot;
  int iterations;
  double vertex_distance_weight;  // rows that have one are shown, but are not of the thesis' ten

  bool is_of_the_thesis() const { return vertex_distance_weight == 0; }
};

const std::vector<Row> table{
    {"armadillo", "armadillo", 0, 6027, 24.494, 5.897, 569, 81, 0},
    {"bumpsphere", "bumpsphere", 1000, 3265, 20.359, 2.993, 201, 55, 0},
    {"bunny", "bunny", 1200, 4975, 61.138, 7.212, 5000, 879, 0},
    {"cube", "cube", 1200, 5153, 39.094, 6.543, 243, 20, 0},
    {"elephant", "elephant", 0, 3818, 26.317, 3.031, 3060, 131, 0},
    {"elephant_with_positions", "elephant", 0, 3818, 26.317, 3.031, 3060, 131, vertex_distance_reference_weight},
    {"gingerbread", "gingerbread", 0, 2238, 5.329, 1.776, 66, 29, 0},
    {"hand", "hand", 0, 2253, 24.403, 2.696, 3229, 1137, 0},
    {"mouse", "mouse", 0, 2633, 22.277, 3.2, 627, 180, 0},
    {"squirrel", "squirrel", 0, 5995, 151.447, 7.744, 105, 103, 0},
    {"teddy", "teddy", 0, 3527, 85.936, 3.492, 484, 106, 0},
};

// Sums over the models that ran, and the worst of each property that all must have.
struct Totals {
  double time = 0, thesis_time = 0, residual = 0, slowest_ratio = HUGE_VAL, least_improvement = HUGE_VAL;
  int models = 0, unstable = 0, self_intersections = 0;
};

// Metrics of one model, and its line of table.csv.
std::string report(Run& run, const Row& row, const TriangleMesh& target, const BalloonDesign& design, Totals& totals)
{
  const auto metric = [&](const char* name, double value, const char* unit) {
    run.metric(fmt::format("{}_{}", name, row.model), value, unit);
  };
  const ShapeDistance optimised = shape_distance(design.inflated, target);
  const ShapeDistance downscaled = shape_distance(design.downscaled, target);
  const BalloonTimes& times = design.times;
  const double improvement = downscaled.mean / optimised.mean, ratio = row.t_tot / times.total;
  const double static_step = times.equilibrium / design.counts.equilibrium_steps;
  const double shape_step = (times.assembly + times.factorization + times.solve) / design.counts.shape_steps;
  const int iterations = static_cast<int>(design.report.trace.size()) - 1;
  const int intersections = count_self_intersections(design.rest);
  metric("time", times.total, "s");
  metric("time_static_step", static_step, "s");
  metric("time_shape_step", shape_step, "s");
  metric("thesis_time_over_ours", ratio, "1");
  metric("iterations", iterations, "1");
  metric("shape_steps", design.counts.shape_steps, "1");
  metric("static_steps", design.counts.equilibrium_steps, "1");
  metric("max_residual", design.residual, "1");
  metric("negative_eigenvalues", design.negative_eigenvalues, "1");
  metric("self_intersections", intersections, "1");
  metric("mean_distance", optimised.mean, "m");
  metric("max_distance", optimised.max, "m");
  metric("downscaled_mean_distance", downscaled.mean, "m");
  metric("downscaled_max_distance", downscaled.max, "m");
  metric("improvement", improvement, "1");

  if (row.is_of_the_thesis()) {
    ++totals.models;
    totals.time += times.total;
    totals.thesis_time += row.t_tot;
  }
  totals.residual = max_or_nan(totals.residual, design.residual);
  totals.unstable += design.negative_eigenvalues != 0;
  totals.self_intersections += intersections;
  // The squirrel's row contradicts itself: 103 iterations of 7.7 s do not fit into 105 s.
  if (std::string(row.model) != "squirrel") totals.slowest_ratio = std::min(totals.slowest_ratio, ratio);
  // The cube's flat faces bulge whatever the rest shape. (4.12) leaves the thin ears of the elephant where they are:
  // its row with vertex distances counts instead.
  if (std::string(row.model) != "cube" && std::string(row.model) != "elephant")
    totals.least_improvement = -max_or_nan(-totals.least_improvement, -improvement);
  return fmt::format("{},{},{},{:.4g},{:.4g},{:.4g},{:.4g},{},{},{},{},{:.4g},{:.4g},{:.4g},{:.4g}\n", row.model,
                     target.vertex_count(), iterations, 1e3 * static_step, 1e3 * shape_step, times.total, ratio,
                     row.t_tot, row.iterations, 1e3 * row.t_stat, 1e3 * row.t_nwtn, 1e3 * optimised.mean,
                     1e3 * optimised.max, 1e3 * downscaled.mean, 1e3 * downscaled.max);
}

void design_all(Run& run)
{
  const std::shared_ptr<const Material> silicone = load_material("silicone");
  std::string lines =
      "model,vertices,iterations,static step [ms],shape step [ms],total [s],thesis total over ours,thesis total [s],"
      "thesis iterations,thesis equilibrium [ms],thesis Newton step [ms],mean distance [mm],max distance [mm],"
      "downscaled mean distance [mm],downscaled max distance [mm]\n";
  Totals totals;
  for (const Row& row : table) {
    const int vertices = run.by_size(row.quick, row.paper);
    if (vertices == 0) continue;
    run.step(row.model);
    const TriangleMesh target = scale_to_diameter(load_dataset(row.dataset, vertices), 0.146);
    const auto observer = run.observer();
    BalloonOptions options;
    options.vertex_distance_weight = row.vertex_distance_weight;
    const BalloonDesign design = design_balloon(target, silicone, options, [&](const BalloonProgress& progress) {
      return progress.iterate == nullptr || observer(*progress.iterate);
    });
    lines += report(run, row, target, design, totals);
    run.trace(fmt::format("trace_{}", row.model), design.report.trace);
  }
  write_text(run.path("table.csv"), lines);

  run.metric("models", totals.models, "1");
  run.metric("time_sum", totals.time, "s");
  run.metric("thesis_time_over_ours", totals.thesis_time / totals.time, "1");
  run.metric("least_thesis_time_over_ours", totals.slowest_ratio, "1");
  run.metric("max_residual", totals.residual, "1");
  run.metric("unstable_models", totals.unstable, "1");
  run.metric("self_intersections", totals.self_intersections, "1");
  run.metric("least_improvement", totals.least_improvement, "1");
}

}  // namespace

int main(int argc, char** argv)
{
  return softform::run_experiment(
      argc, argv, {"table_4_1", "4.6", "Ten balloons together take at most a sixtieth of the thesis' time.", {0.2, 3}},
      design_all);
}
