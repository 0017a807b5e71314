// Purpose: from a target with a nozzle to a mould that can be printed (thesis sections 4.4.2 and 4.5.1, figure 4.5):
// the rest shape on the nozzle's tube on a plate with screw holes, solid and hollow, and the balloon that comes off it.
// Claim: the mould is watertight, and the nozzle's vertices have the same places at rest and inflated.

#include <algorithm>
#include <limits>

#include "softform/balloons/balloon_design.hpp"
#include "softform/balloons/mould.hpp"
#include "softform/experiment/experiment.hpp"
#include "softform/experiment/run.hpp"
#include "softform/io/datasets.hpp"
#include "softform/io/mesh_io.hpp"
#include "softform/io/threemf.hpp"
#include "softform/io/vtk_io.hpp"
#include "softform/materials/material_file.hpp"
#include "softform/mesh/check.hpp"
#include "softform/mesh/distance.hpp"
#include "softform/mesh/self_intersections.hpp"

namespace {

using namespace softform;

double nozzle_displacement(const TriangleMesh& shape, const TriangleMesh& target, const Nozzle& nozzle)
{
  return (shape.vertices - target.vertices)(nozzle.vertices, Eigen::all).rowwise().norm().maxCoeff();
}

Vec as_numbers(const std::vector<char>& flags)
{
  Vec numbers(static_cast<Eigen::Index>(flags.size()));
  for (std::size_t i = 0; i < flags.size(); ++i) numbers[static_cast<Eigen::Index>(i)] = flags[i];
  return numbers;
}

// The smallest distance of the hollow, inside the rest shape, to the rest shape's surface.
double thinnest_wall(const TriangleMesh& hollow, const TriangleMesh& rest, const Nozzle& nozzle)
{
  const Vec distances = SurfaceDistance(rest).distances(hollow.vertices);
  const Vec along = (hollow.vertices.rowwise() - nozzle.position.transpose()) * nozzle.axis;
  double thinnest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < hollow.vertex_count(); ++i)
    if (along[i] < -nozzle.radius && distances[i] > 1e-6) thinnest = std::min(thinnest, distances[i]);
  return thinnest;
}

void make_balloon_and_mould(Run& run)
{
  // 1. The bunny, 14.6 cm, blown up from below: its balloon, held by the nozzle. The coarse mesh wants a wider one.
  const TriangleMesh target = scale_to_diameter(load_dataset("bunny", run.by_size(1200, 4975)), 0.146);
  BalloonOptions options;
  options.nozzle = NozzlePlacement{.direction = -Vec3::UnitY(), .diameter = run.by_size(20e-3, 12e-3)};
  run.step("designing the bunny");
  const auto observer = run.observer();
  const BalloonDesign design = design_balloon(
      target, load_material("silicone"), options,
      [&](const BalloonProgress& progress) { return progress.iterate == nullptr || observer(*progress.iterate); });
  const Nozzle& nozzle = design.nozzle.value();
  const TriangleMesh inflated = aligned_to(target, flatten(design.inflated.vertices));

  // 2. Its moulds: solid, and hollow with a wall of 2 mm.
  run.step("making the moulds");
  const Mould solid = make_mould(design.rest, nozzle);
  const Mould hollow = make_mould(design.rest, nozzle, {.wall = 2e-3});
  const MouldInspection found = inspect_mould(solid.surface, design.rest, pull_directions(nozzle), 0.5e-3);
  const MouldInspection wall = inspect_mould(hollow.surface, design.rest, pull_directions(nozzle), 0.5e-3);

  // 3. Files: for the printer in millimetres, for the figure in metres.
  TriangleMesh in_millimetres = solid.surface;
  in_millimetres.vertices *= 1e3;
  write_mesh(run.path("mould.stl"), in_millimetres);
  write_3mf(run.path("mould.3mf"), solid.surface);
  write_vtp(run.path("mould.vtp"), solid.surface, {{}, {{"trapped [1]", as_numbers(found.trapped)}}});
  write_vtp(run.path("hollow.vtp"), hollow.surface, {{}, {{"thickness [m]", wall.thickness}}});
  write_vtp(run.path("rest.vtp"), design.rest);
  write_vtp(run.path("inflated.vtp"), design.inflated);

  // 4. The file that a printer gets is read again and checked.
  const TriangleMesh printed = read_mesh(run.path("mould.stl"));
  const MeshReport report = check_mesh(printed);
  run.metric("problems_of_the_stl", static_cast<double>(report.problems.size()), "1");
  run.metric("self_intersections_of_the_stl", count_self_intersections(printed), "1");
  run.metric("genus_solid", solid.genus, "1");
  run.metric("genus_hollow", hollow.genus, "1");
  run.metric("volume_of_the_stl_to_the_mould", 1e-9 * enclosed_volume(printed) / enclosed_volume(solid.surface), "1");
  run.metric("volume_solid", enclosed_volume(solid.surface), "m^3");
  run.metric("volume_rest", enclosed_volume(design.rest), "m^3");
  run.metric("volume_hollow", enclosed_volume(hollow.surface), "m^3");
  run.metric("thinnest_wall", thinnest_wall(hollow.surface, design.rest, nozzle), "m");
  run.metric("smallest_thickness_hollow", wall.smallest_thickness, "m");
  run.metric("smallest_thickness_solid", found.smallest_thickness, "m");
  run.metric("smallest_gap", found.smallest_gap, "m");
  run.metric("trapped_area_fraction", found.trapped_fraction, "1");
  run.metric("nozzle_displacement_rest", nozzle_displacement(design.rest, target, nozzle), "m");
  run.metric("nozzle_displacement_inflated", nozzle_displacement(design.inflated, target, nozzle), "m");
  run.metric("mean_distance", shape_distance(inflated, target).mean, "m");
  run.metric("max_distance", shape_distance(inflated, target).max, "m");
  run.metric("improvement",
             shape_distance(aligned_to(target, flatten(design.downscaled.vertices)), target).mean /
                 shape_distance(inflated, target).mean,
             "1");
  run.metric("volume_inflated_to_target", enclosed_volume(design.inflated) / enclosed_volume(target), "1");
  run.metric("self_intersections_rest", count_self_intersections(design.rest), "1");
  run.metric("negative_eigenvalues", design.negative_eigenvalues, "1");
  run.metric("max_residual", design.residual, "1");
  run.metric("time_design", design.times.total, "s");
}

}  // namespace

int main(int argc, char** argv)
{
  return softform::run_experiment(
      argc, argv,
      {"fig_4_5", "4.5", "Rest shape, nozzle tube and plate make a watertight mould that can be printed.", {0.5, 3}},
      make_balloon_and_mould);
}
