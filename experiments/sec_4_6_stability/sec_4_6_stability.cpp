// Purpose: whether the optimum is well separated from others (thesis section 4.6). The teddy's optimised rest shape is
// perturbed by a smooth random displacement of 0.25 cm in the mean and optimised again, for the same target, pressure
// and regularisers. Both runs are converged to round-off, as far as that goes.
// Claim: the new optimum differs from the first by less than 1e-4 cm in the mean.

#include "softform/balloons/balloon_design.hpp"
#include "softform/balloons/thickness_noise.hpp"
#include "softform/experiment/experiment.hpp"
#include "softform/experiment/run.hpp"
#include "softform/io/datasets.hpp"
#include "softform/io/vtk_io.hpp"
#include "softform/materials/material_file.hpp"
#include "softform/mesh/alignment.hpp"
#include "softform/mesh/self_intersections.hpp"

namespace {

using namespace softform;

constexpr double displacement = 2.5e-3;      // [m] in the mean
constexpr double correlation_length = 8e-2;  // [m]: shorter waves of that height make the limbs cut the body
// Weight of the rest shape's bending per vertex: far more than the 0.003 of the other experiments, and as stiff on any
// mesh, since the squares of the angles at the edges fall with the number of vertices.
constexpr double firm_rest_bending = 1e-4;

// Mean distance of corresponding vertices after the best rigid motion [m].
double mean_difference(const Positions& a, const Positions& b)
{
  return (rigid_alignment(a, b)(a) - b).rowwise().norm().mean();
}

// The shapes as optimised, before they were sized.
BalloonStart unsized(const BalloonDesign& design)
{
  return {design.rest.vertices / design.size_factor, design.inflated.vertices / design.size_factor};
}

// A rest shape displaced by three independent fields, one a coordinate, of which the rigid motion is taken out.
Positions perturbed(const Positions& rest, const Triangles& triangles, unsigned seed)
{
  const SurfaceNoise noise({rest, triangles}, correlation_length);
  Positions moved = rest;
  for (unsigned axis = 0; axis < 3; ++axis) moved.col(axis) += displacement * noise.on_vertices(10 * seed + axis);
  const Positions offsets = rigid_alignment(moved, rest)(moved) - rest;
  return rest + displacement / offsets.rowwise().norm().mean() * offsets;
}

// Optimises, perturbs the optimum and optimises again.
void restart(Run& run, const TriangleMesh& target, const std::string& name, BalloonOptions options)
{
  const std::shared_ptr<const Material> silicone = load_material("silicone");
  const auto observer = run.observer();
  const auto design_from = [&](const std::optional<BalloonStart>& start) {
    options.start = start;
    return design_balloon(target, silicone, options, [&](const BalloonProgress& progress) {
      return progress.iterate == nullptr || observer(*progress.iterate);
    });
  };
  run.step(name + ": first optimum");
  const BalloonDesign first = design_from(std::nullopt);
  const BalloonStart optimum = unsized(first);
  const Positions moved = perturbed(optimum.rest, target.triangles, run.seed());
  run.step(name + ": again from the perturbed one");
  const BalloonDesign second = design_from(BalloonStart{moved, optimum.inflated});
  const BalloonStart again = unsized(second);

  run.metric("perturbation_" + name, mean_difference(moved, optimum.rest), "m");
  run.metric("self_intersections_perturbed_" + name, count_self_intersections({moved, target.triangles}), "1");
  run.metric("rest_difference_" + name, mean_difference(again.rest, optimum.rest), "m");
  run.metric("inflated_difference_" + name, mean_difference(again.inflated, optimum.inflated), "m");
  run.metric("objective_first_" + name, first.report.trace.back().objective, "1");
  run.metric("objective_again_" + name, second.report.trace.back().objective, "1");
  run.metric("negative_eigenvalues_" + name, std::max(first.negative_eigenvalues, second.negative_eigenvalues), "1");
  run.metric("mean_distance_" + name, shape_distance(first.inflated, target).mean, "m");
  run.metric("downscaled_mean_distance_" + name, shape_distance(first.downscaled, target).mean, "m");
  run.trace("trace_first_" + name, first.report.trace);
  run.trace("trace_again_" + name, second.report.trace);
  write_vtp(run.path("optimum_" + name + ".vtp"), {optimum.rest, target.triangles});
  write_vtp(run.path("perturbed_" + name + ".vtp"), {moved, target.triangles});
  write_vtp(run.path("again_" + name + ".vtp"), {again.rest, target.triangles});
  write_vtp(run.path("inflated_" + name + ".vtp"), {again.inflated, target.triangles});
}

TriangleMesh teddy(int vertices) { return scale_to_diameter(load_dataset("teddy", vertices), 0.146); }

void restart_from_perturbed_optimum(Run& run)
{
  BalloonOptions options;
  options.stop.relative_decrease = 1e-11;

  // 1. With a firm hold on the rest shape's curvature the optimum is reached to round-off.
  options.stop.max_iterations = 200;
  const TriangleMesh target = teddy(run.by_size(1000, 3527));
  options.rest_bending_weight = firm_rest_bending * target.vertex_count();
  restart(run, target, "firm", options);

  // 2. With the weight of the other experiments the optimum lies in a flat valley, which 60 iterations do not end. The
  // coarse teddy shows it.
  if (!run.is_paper()) return;
  options.stop.max_iterations = 60;
  options.rest_bending_weight = BalloonOptions{}.rest_bending_weight;
  restart(run, teddy(1000), "default", options);
}

}  // namespace

int main(int argc, char** argv)
{
  return softform::run_experiment(
      argc, argv,
      {"sec_4_6_stability",
       "4.6",
       "From an optimum perturbed by 0.25 cm the optimisation returns to it within 1e-4 cm.",
       {0.2, 8}},
      restart_from_perturbed_optimum);
}
