// Purpose: rest shapes of rubber balloons that inflate to their targets, beside downscaled targets that do not (thesis
// section 4.6, figure 4.6). Each model is designed by (4.12)-(4.14): the force balance f(x, X) = 0 as constraint, the
// distance of the inflated shape from the target as objective.
// Claim: inflated, the optimised rest shape is far closer to the target than the downscaled one; symmetric targets
// stay symmetric on irregular meshes. Metrics named unsized_* are those of (4.12) alone, before the balloon is sized to
// the target's volume; rows "with positions" add the aligned vertex-distance term. The thesis has neither.

#include <fmt/format.h>

#include "softform/balloons/balloon_design.hpp"
#include "softform/experiment/experiment.hpp"
#include "softform/experiment/run.hpp"
#include "softform/io/datasets.hpp"
#include "softform/io/vtk_io.hpp"
#include "softform/materials/material_file.hpp"
#include "softform/mesh/alignment.hpp"
#include "softform/mesh/curvature.hpp"
#include "softform/mesh/self_intersections.hpp"

namespace {

using namespace softform;

// Largest distance between two vertices, that of the thesis' bunny [m].
constexpr double size = 0.146;

struct Model {
  const char* name;  // of the metrics and files
  const char* dataset;
  int quick, paper;  // vertices, 0 to leave it out; the paper's are those of table 4.1
  double vertex_distance_weight;
  bool is_symmetric;  // to the coordinate planes
};

const std::vector<Model> models{
    {"bumpsphere", "bumpsphere", 1000, 3265, 0, true},
    {"cube", "cube", 1200, 5153, 0, true},
    {"bunny", "bunny", 1200, 4975, 0, false},
    {"bunny_with_positions", "bunny", 1200, 4975, vertex_distance_reference_weight, false},
    {"gingerbread", "gingerbread", 800, 2238, 0, false},
    {"mouse", "mouse", 0, 2633, 0, false},
    {"squirrel", "squirrel", 0, 5995, 0, false},
    {"squirrel_with_positions", "squirrel", 0, 5995, vertex_distance_reference_weight, false},
    {"teddy", "teddy", 0, 3527, 0, false},
    {"armadillo", "armadillo", 0, 6027, 0, false},
    {"elephant", "elephant", 0, 3818, 0, false},
    {"elephant_with_positions", "elephant", 0, 3818, vertex_distance_reference_weight, false},
    {"hand", "hand", 0, 2253, 0, false},
    {"hand_with_positions", "hand", 0, 2253, vertex_distance_reference_weight, false},
};

void write_shapes(Run& run, const Model& model, const TriangleMesh& target, const BalloonDesign& design)
{
  const auto file = [&](const char* shape) { return run.path(fmt::format("{}_{}.vtp", model.name, shape)); };
  Vec distance;
  shape_distance(design.inflated, target, &distance);
  write_vtp(file("target"), target);
  write_vtp(file("rest"), design.rest);
  write_vtp(file("inflated"), design.inflated, {{{"distance [m]", distance}}, {}});
  write_vtp(file("downscaled"), design.downscaled);
}

// Relative to the size; vertex by vertex the shape is turned back to the target's axes before it is mirrored.
double asymmetry(const TriangleMesh& shape, const TriangleMesh& target)
{
  const Positions upright = rigid_alignment(shape.vertices, target.vertices)(shape.vertices);
  return mirror_asymmetry({upright, shape.triangles}) / diameter(upright);
}

void report(Run& run, const Model& model, const TriangleMesh& target, const BalloonDesign& design)
{
  const auto metric = [&](const char* name, double value, const char* unit) {
    run.metric(fmt::format("{}_{}", name, model.name), value, unit);
  };
  const ShapeDistance optimised = shape_distance(design.inflated, target);
  const ShapeDistance unsized =
      shape_distance(aligned_to(target, flatten(design.inflated.vertices) / design.size_factor), target);
  const ShapeDistance downscaled = shape_distance(design.downscaled, target);
  metric("mean_distance", optimised.mean, "m");
  metric("max_distance", optimised.max, "m");
  metric("unsized_mean_distance", unsized.mean, "m");
  metric("unsized_max_distance", unsized.max, "m");
  metric("size_factor", design.size_factor, "1");
  metric("downscaled_mean_distance", downscaled.mean, "m");
  metric("downscaled_max_distance", downscaled.max, "m");
  metric("improvement", downscaled.mean / optimised.mean, "1");
  metric("unsized_improvement", downscaled.mean / unsized.mean, "1");
  metric("pressure", design.pressure, "Pa");
  metric("mean_stretch", design.mean_stretch, "1");
  metric("max_residual", design.residual, "1");
  metric("negative_eigenvalues", design.negative_eigenvalues, "1");
  metric("self_intersections", count_self_intersections(design.rest), "1");
  metric("inflated_self_intersections", count_self_intersections(design.inflated), "1");
  metric("iterations", double(design.report.trace.size()) - 1, "1");
  metric("time_inflation", design.times.inflation, "s");
  metric("time", design.times.total, "s");
  if (model.is_symmetric) {
    metric("rest_asymmetry", asymmetry(design.rest, target), "1");
    metric("inflated_asymmetry", asymmetry(design.inflated, target), "1");
  }
}

void run_models(Run& run)
{
  const std::shared_ptr<const Material> silicone = load_material("silicone");
  for (const Model& model : models) {
    const int vertices = run.by_size(model.quick, model.paper);
    if (vertices == 0) continue;
    run.step(model.name);
    // 1. The target, at the size of the thesis' bunny.
    const TriangleMesh target = scale_to_diameter(load_dataset(model.dataset, vertices), size);

    // 2. The rest shape at the pressure that inflates the downscaled target to the target's volume.
    BalloonOptions options;
    options.vertex_distance_weight = model.vertex_distance_weight;
    const auto observer = run.observer();
    const BalloonDesign design = design_balloon(target, silicone, options, [&](const BalloonProgress& progress) {
      return progress.iterate == nullptr || observer(*progress.iterate);
    });

    // 3. Shapes, distances and the trace.
    write_shapes(run, model, target, design);
    report(run, model, target, design);
    run.trace(fmt::format("trace_{}", model.name), design.report.trace);
  }
}

}  // namespace

int main(int argc, char** argv)
{
  return softform::run_experiment(
      argc, argv,
      {"fig_4_6",
       "4.6",
       "Optimised rest shapes inflate far closer to their targets than downscaled targets do.",
       {1, 8}},
      run_models);
}
