// Purpose: the whole way from a target shape to a mould, for one model (thesis section 4.2, figure 4.1).
// Claim: material, inflation of the downscaled target, optimisation and mould follow each other without anything done
// by hand in between, and the last one's input is the one's before it.

#include "softform/balloons/balloon_design.hpp"
#include "softform/balloons/mould.hpp"
#include "softform/balloons/nozzle_smoothing.hpp"
#include "softform/experiment/experiment.hpp"
#include "softform/experiment/run.hpp"
#include "softform/io/datasets.hpp"
#include "softform/io/vtk_io.hpp"
#include "softform/materials/material_file.hpp"
#include "softform/mesh/check.hpp"
#include "softform/mesh/distance.hpp"

namespace {

using namespace softform;

void run_pipeline(Run& run)
{
  // 1. The target, 14.6 cm, and where it will be blown up: from below.
  const TriangleMesh target = scale_to_diameter(load_dataset("teddy", run.by_size(1000, 3527)), 0.146);
  BalloonOptions options;
  options.nozzle = NozzlePlacement{.direction = -Vec3::UnitY(), .diameter = run.by_size(20e-3, 12e-3)};
  write_vtp(run.path("target.vtp"), target);

  // 2. The first rest shape: scaled down, the nozzle in its own size.
  const Nozzle nozzle = place_nozzle(target, *options.nozzle);
  write_vtp(run.path("downscaled.vtp"), rest_shape_with_nozzle(target, nozzle, options.rest_scale));

  // 3. The optimal rest shape in silicone, and what it inflates into.
  run.step("designing the teddy");
  const auto observer = run.observer();
  const BalloonDesign design = design_balloon(
      target, load_material("silicone"), options,
      [&](const BalloonProgress& progress) { return progress.iterate == nullptr || observer(*progress.iterate); });
  write_vtp(run.path("rest.vtp"), design.rest);
  write_vtp(run.path("inflated.vtp"), design.inflated);

  // 4. Its mould.
  run.step("making the mould");
  const Mould mould = make_mould(design.rest, nozzle);
  write_vtp(run.path("mould.vtp"), mould.surface);

  // 5. Whether each step used the one before: the mould holds the rest shape, which balances at the pressure.
  const auto distance = [&](const TriangleMesh& shape) {
    return shape_distance(aligned_to(target, flatten(shape.vertices)), target).mean;
  };
  const Vec on_mould = SurfaceDistance(mould.surface).distances(design.rest.vertices);
  int outside_tube = 0, on_surface = 0;
  for (int i = 0; i < design.rest.vertex_count(); ++i) {
    const Vec3 offset = design.rest.vertices.row(i).transpose() - nozzle.position;
    const double across = (offset - offset.dot(nozzle.axis) * nozzle.axis).norm();
    if (across < 1.01 * nozzle.radius) continue;
    ++outside_tube;
    on_surface += on_mould[i] < 1e-7 ? 1 : 0;
  }
  run.metric("rest_vertices_on_the_mould", double(on_surface) / outside_tube, "1");
  run.metric("problems_of_the_mould", static_cast<double>(check_mesh(mould.surface).problems.size()), "1");
  run.metric("improvement", distance(design.downscaled) / distance(design.inflated), "1");
  run.metric("mean_distance", distance(design.inflated), "m");
  run.metric("pressure", design.pressure, "Pa");
  run.metric("mean_stretch", design.mean_stretch, "1");
  run.metric("negative_eigenvalues", design.negative_eigenvalues, "1");
  run.metric("max_residual", design.residual, "1");
  run.metric("time_design", design.times.total, "s");
}

}  // namespace

int main(int argc, char** argv)
{
  return softform::run_experiment(
      argc, argv, {"fig_4_1", "4.2", "From target to mould: nothing is done by hand between the steps.", {0.3, 2}},
      run_pipeline);
}
