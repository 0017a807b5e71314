// Purpose: how much the material model matters (thesis section 4.6). A bunny balloon is designed with the Hart-Smith
// model; its rest shape is then inflated to the same volume with the Mooney-Rivlin model, fitted to the same tests of
// the same silicone, and to the same pressure, far beyond what Mooney-Rivlin bears before it gives way.
// Claim: with Hart-Smith the ears are clearly visible, with Mooney-Rivlin they are lost and the bunny is almost a
// sphere.

#include <cmath>
#include <map>

#include "softform/balloons/balloon_design.hpp"
#include "softform/experiment/experiment.hpp"
#include "softform/experiment/run.hpp"
#include "softform/fitting/parameter_fit.hpp"
#include "softform/io/datasets.hpp"
#include "softform/io/vtk_io.hpp"

namespace {

using namespace softform;

constexpr double rest_scale = 0.4;  // for a mean extension near 2, within the thesis' 2.5 and the data

// 1 for a sphere: the area of the sphere of the same volume over the shape's (Wadell 1935).
double sphericity(const TriangleMesh& shape)
{
  const double volume = enclosed_volume(shape), area = surface_area(flatten(shape.vertices), shape.triangles);
  return std::cbrt(36 * M_PI * volume * volume) / area;
}

// How far the farthest vertex lies outside the sphere of the same volume about the centroid, over its radius: the tips
// of the ears.
double prominence(const TriangleMesh& shape)
{
  const Vec areas = vertex_areas(flatten(shape.vertices), shape.triangles);
  const Eigen::RowVector3d centroid = areas.transpose() * shape.vertices / areas.sum();
  const double radius = std::cbrt(3 * enclosed_volume(shape) / (4 * M_PI));
  return (shape.vertices.rowwise() - centroid).rowwise().norm().maxCoeff() / radius - 1;
}

// The designed rest shape in one material.
class Balloon {
 public:
  Balloon(const BalloonDesign& design, const std::shared_ptr<const Material>& material)
      : membrane_(design.rest.triangles, design.rest.vertex_count(), material,
                  Vec::Constant(design.rest.triangle_count(), BalloonOptions{}.thickness)),
        balloon_(membrane_, flatten(design.rest.vertices))
  {}

  Equilibrium at_volume(double volume, CsvTable& path)
  {
    return inflate_to_volume(balloon_, volume, factorization_, {}, {}, [&](const InflationStep& step, const Vec&) {
      path.add_row({step.volume / balloon_.rest_volume(), step.pressure});
      return true;
    });
  }
  Equilibrium at_pressure(double pressure)
  {
    constexpr double largest_volume_ratio = 1e6;  // Mooney-Rivlin gives way by far more than a factor of 1000
    return inflate_to_pressure(balloon_, pressure, factorization_, {}, largest_volume_ratio);
  }

  int negative_eigenvalues(const Equilibrium& state)
  {
    SparseMatrix K;
    PressurePotential(balloon_, state.pressure, state.x).hessian(state.x, K);
    return count_negative_eigenvalues(std::move(K), factorization_);
  }

 private:
  Membrane membrane_;
  PressurizedMembrane balloon_;
  SparseFactorization factorization_;
};

// Shapes and distances of a state, scaled to the target's volume.
void report(Run& run, const TriangleMesh& target, const std::string& name, const Equilibrium& state)
{
  const double ratio = enclosed_volume(state.x, target.triangles) / enclosed_volume(target);
  const TriangleMesh shape = aligned_to(target, state.x / std::cbrt(ratio));
  Vec distances;
  const ShapeDistance distance = shape_distance(shape, target, &distances);
  write_vtp(run.path(name + ".vtp"), shape, {{{"distance [m]", distances}}, {}});
  run.metric("converged_" + name, state.report.converged(), "1");
  run.metric("volume_over_target_" + name, ratio, "1");
  run.metric("mean_distance_" + name, distance.mean, "m");
  run.metric("max_distance_" + name, distance.max, "m");
  run.metric("sphericity_" + name, sphericity(shape), "1");
  run.metric("ears_kept_" + name, prominence(shape) / prominence(target), "1");
}

void compare_materials(Run& run)
{
  // 1. Both models fitted to the same tests.
  const std::vector<RubberTest> tests{load_rubber_test("meunier_2008_silicone_uniaxial"),
                                      load_rubber_test("meunier_2008_silicone_equibiaxial")};
  run.step("fitting");
  const auto hart_smith = fit_material("hart_smith", tests, {}).material;
  const auto mooney_rivlin = fit_material("mooney_rivlin", tests, {}).material;
  run.metric("fit_error_hart_smith", stress_error(*hart_smith, tests).mean_relative, "1");
  run.metric("fit_error_mooney_rivlin", stress_error(*mooney_rivlin, tests).mean_relative, "1");

  // 2. The bunny designed with Hart-Smith.
  TriangleMesh target = load_dataset("bunny", run.by_size(1200, 4975));
  target = scale_to_diameter(target, 0.146);
  BalloonOptions options;
  options.rest_scale = rest_scale;
  run.step("designing the bunny");
  const auto observer = run.observer();
  const BalloonDesign design = design_balloon(target, hart_smith, options, [&](const BalloonProgress& progress) {
    return progress.iterate == nullptr || observer(*progress.iterate);
  });
  write_vtp(run.path("target.vtp"), target);
  write_vtp(run.path("rest.vtp"), design.rest);
  run.metric("sphericity_target", sphericity(target), "1");
  run.metric("mean_stretch", design.mean_stretch, "1");
  run.metric("pressure", design.pressure, "Pa");
  run.metric("negative_eigenvalues", design.negative_eigenvalues, "1");

  // 3. Its rest shape inflated to the target's volume with both, and with Mooney-Rivlin to the design's pressure.
  const std::map<std::string, std::shared_ptr<const Material>> materials{{"hart_smith", hart_smith},
                                                                         {"mooney_rivlin", mooney_rivlin}};
  for (const auto& [name, material] : materials) {
    run.step("inflating with " + name);
    Balloon balloon(design, material);
    auto& path = run.series("path_" + name, {{"volume_ratio", "1"}, {"pressure", "Pa"}});
    const Equilibrium state = balloon.at_volume(enclosed_volume(target), path);
    report(run, target, name, state);
    run.metric("pressure_over_designed_" + name, state.pressure / design.pressure, "1");
    run.metric("negative_eigenvalues_" + name, balloon.negative_eigenvalues(state), "1");
  }
  run.step("inflating with mooney_rivlin to the design's pressure");
  Balloon balloon(design, mooney_rivlin);
  const Equilibrium state = balloon.at_pressure(design.pressure);
  report(run, target, "mooney_rivlin_at_pressure", state);
  run.metric("negative_eigenvalues_mooney_rivlin_at_pressure", balloon.negative_eigenvalues(state), "1");
}

}  // namespace

int main(int argc, char** argv)
{
  return softform::run_experiment(argc, argv,
                                  {"sec_4_6_material",
                                   "4.6",
                                   "Inflated with Mooney-Rivlin the bunny loses the ears that Hart-Smith keeps.",
                                   {0.2, 2}},
                                  compare_materials);
}
