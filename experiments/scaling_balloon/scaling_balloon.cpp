// Purpose: how the time of a whole design grows with the mesh, and where it goes: one shape, the bumpsphere, resolved
// by ever more vertices (not in the thesis; its table 4.1 has one size a model).
// Claim: the time grows no faster than n^1.3 from 1000 to 20 000 vertices. Factorising a matrix of a surface mesh costs
// n^1.5 and assembling it n, so that more could only come from iterations that grow with n.

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "softform/balloons/balloon_design.hpp"
#include "softform/core/statistics.hpp"
#include "softform/experiment/experiment.hpp"
#include "softform/experiment/run.hpp"
#include "softform/materials/material_file.hpp"
#include "softform/mesh/self_intersections.hpp"
#include "softform/mesh/shapes.hpp"

namespace {

using namespace softform;

// The exponent of the power law through the points, by least squares of the logarithms.
double fitted_exponent(const std::vector<double>& n, const std::vector<double>& seconds)
{
  const auto size = static_cast<Eigen::Index>(n.size());
  const Vec x = Eigen::Map<const Vec>(n.data(), size).array().log();
  const Vec y = Eigen::Map<const Vec>(seconds.data(), size).array().log();
  const Vec centred = x.array() - x.mean();
  return centred.dot(y) / centred.squaredNorm();
}

void design_at_all_sizes(Run& run)
{
  const std::shared_ptr<const Material> silicone = load_material("silicone");
  const std::vector<int> sizes = run.by_size<std::vector<int>>({1000, 1400, 2000}, {1000, 2000, 5000, 10000, 20000});
  CsvTable& table = run.series("scaling", {{"vertices"},
                                           {"inflation", "s"},
                                           {"assembly", "s"},
                                           {"factorization", "s"},
                                           {"solve", "s"},
                                           {"equilibrium", "s"},
                                           {"collision", "s"},
                                           {"rest", "s"},
                                           {"total", "s"},
                                           {"shape steps"},
                                           {"static steps"}});
  std::vector<double> vertices, totals, factorizations;
  int most_steps = 0, unstable = 0, intersections = 0;
  double residual = 0;
  for (const int n : sizes) {
    // 1. The same surface, 14.6 cm, on n vertices.
    run.step(fmt::format("{} vertices", n));
    const TriangleMesh target = scale_to_diameter(bumpsphere(1, n), 0.146);

    // 2. The design, with its times by phase.
    const auto observer = run.observer();
    const BalloonDesign design = design_balloon(target, silicone, {}, [&](const BalloonProgress& progress) {
      return progress.iterate == nullptr || observer(*progress.iterate);
    });
    const BalloonTimes& times = design.times;
    const BalloonCounts& counts = design.counts;
    table.add_row({double(n), times.inflation, times.assembly, times.factorization, times.solve, times.equilibrium,
                   times.collision, times.rest(), times.total, double(counts.shape_steps),
                   double(counts.equilibrium_steps)});
    run.metric(fmt::format("time_{}", n), times.total, "s");
    run.metric(fmt::format("shape_steps_{}", n), counts.shape_steps, "1");
    run.metric(fmt::format("static_steps_{}", n), counts.equilibrium_steps, "1");
    run.metric(fmt::format("mean_distance_{}", n), shape_distance(design.inflated, target).mean, "m");

    // 3. Times count for balloons that can be made.
    vertices.push_back(n);
    totals.push_back(times.total);
    factorizations.push_back(times.factorization / counts.shape_steps);
    most_steps = std::max(most_steps, counts.shape_steps);
    residual = max_or_nan(residual, design.residual);
    unstable += design.negative_eigenvalues != 0;
    intersections += count_self_intersections(design.rest);
  }
  run.metric("exponent", fitted_exponent(vertices, totals), "1");
  run.metric("exponent_of_one_factorization", fitted_exponent(vertices, factorizations), "1");
  run.metric("most_shape_steps", most_steps, "1");
  run.metric("max_residual", residual, "1");
  run.metric("unstable_designs", unstable, "1");
  run.metric("self_intersections", intersections, "1");
}

}  // namespace

int main(int argc, char** argv)
{
  return softform::run_experiment(
      argc, argv, {"scaling_balloon", "4.6", "The time of a whole design grows no faster than n^1.3.", {0.2, 3}},
      design_at_all_sizes);
}
