// Purpose: the relaxed energy on the teddy at about 3k, 15k and 59k elements, and the full neo-Hookean energy (6.3) on
// the finest (thesis 6.7, figure 6.11). The structure is the teddy's surface itself, every triangle its own flat piece.
// Claim: coarse meshes are close to fine ones, and the relaxed energy is solved far faster than the full one.

#include <random>

#include "softform/experiment/experiment.hpp"
#include "softform/experiment/run.hpp"
#include "softform/inflatables/inflatable.hpp"
#include "softform/inflatables/pillow.hpp"
#include "softform/io/datasets.hpp"
#include "softform/io/vtk_io.hpp"
#include "softform/materials/registry.hpp"
#include "softform/materials/tension_field.hpp"
#include "softform/mesh/alignment.hpp"
#include "softform/mesh/distance.hpp"
#include "softform/mesh/remesh.hpp"

namespace {

using namespace softform;

// A unit-size model of a foil with kappa h = 500 p x size, and a residual stiffness that pulls with 1e-3 p x size.
constexpr double kappa = 5e6, thickness = 1e-4, pressure = 1, residual = 2e-6;

// Every mesh is remeshed from the same one, so that all approximate one shape.
TriangleMesh teddy(int vertices)
{
  const TriangleMesh source = load_dataset("teddy", 3527);
  const TriangleMesh mesh = vertices == 3527 ? source : remesh_to_vertex_count(source, vertices);
  return scale_to_diameter(mesh, 1);
}

struct Solved {
  TriangleMesh mesh;
  Equilibrium equilibrium;
  Vec compression;
  double energy = 0;  // [J]
  double cpu_s = 0;
  int negative_eigenvalues = -1;
};

Solved inflate_surface(const TriangleMesh& target, std::shared_ptr<const Material> material, const Vec& x0,
                       const NewtonOptions& options = inflation_options())
{
  const PanelLayout layout = triangles_apart(target);
  const Inflatable inflatable(layout, std::move(material), thickness, pressure);
  const Vec flat = flat_vector(layout);
  SparseFactorization factorization;
  Solved solved;
  const double start = Run::cpu_s();
  solved.equilibrium = inflate(inflatable, flat, x0, factorization, options);
  solved.cpu_s = Run::cpu_s() - start;
  solved.energy = inflatable.value(solved.equilibrium.x, flat);
  SparseMatrix K;
  inflatable.hessian(solved.equilibrium.x, flat, K);
  solved.negative_eigenvalues = count_negative_eigenvalues(std::move(K), factorization);
  solved.mesh = {unflatten(solved.equilibrium.x), target.triangles};
  solved.compression = inflatable.compression(solved.equilibrium.x, flat);
  return solved;
}

// Of the vertices to the reference's surface, for a model of size 1, which floats freely: after the best rigid motion.
Vec distances_to(const Solved& reference, const TriangleMesh& mesh)
{
  const SurfaceDistance surface(reference.mesh);
  return surface.distances(rigid_alignment(mesh.vertices, surface)(mesh.vertices));
}

void report(Run& run, const std::string& name, const Solved& solved)
{
  run.metric("elements_" + name, solved.mesh.triangle_count(), "1");
  run.metric("iterations_" + name, solved.equilibrium.iterations, "1");
  run.metric("linear_solves_" + name, solved.equilibrium.report.evaluations.linear_solve, "1");
  run.metric("time_cpu_" + name, solved.cpu_s, "s");
  run.metric("max_residual_" + name, solved.equilibrium.residual, "1");
  run.metric("negative_eigenvalues_" + name, solved.negative_eigenvalues, "1");
  run.metric("energy_" + name, solved.energy, "J");
  run.metric("volume_" + name, enclosed_volume(solved.mesh), "1");
  run.trace("trace_" + name, solved.equilibrium.report.trace);
}

// Wrinkles need something to start from: nodes off by a hundredth of an edge.
Vec disturbed(const Solved& solved, unsigned seed)
{
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0, 0.01 * mean_edge_length(solved.mesh));
  return solved.equilibrium.x.unaryExpr([&](double coordinate) { return coordinate + normal(random); });
}

void compare_energies(Run& run)
{
  const std::vector<std::string> names{"coarse", "medium", "fine"};
  const std::vector<int> vertices = run.by_size<std::vector<int>>({400, 800, 1600}, {1489, 7502, 29502});
  const auto relaxed = std::make_shared<TensionField>(kappa, 0, residual);

  // 1. The relaxed energy at three resolutions, from the target's surface.
  std::vector<Solved> solved;
  for (std::size_t i = 0; i < names.size(); ++i) {
    run.step("relaxed energy, " + names[i]);
    const TriangleMesh target = teddy(vertices[i]);
    run.time(names[i], [&] { solved.push_back(inflate_surface(target, relaxed, flatten(target.vertices))); });
    report(run, names[i], solved.back());
  }

  // 2. The full energy on the finest mesh, from the relaxed solution, disturbed.
  run.step("full energy, fine");
  const TriangleMesh finest = teddy(vertices.back());
  const std::shared_ptr<const Material> full = make_material("neo_hookean", {{"mu", 2 * kappa}});
  NewtonOptions patient = inflation_options();
  patient.max_iterations = 3000;
  Solved reference;
  run.time("full", [&] { reference = inflate_surface(finest, full, disturbed(solved.back(), run.seed()), patient); });
  report(run, "full", reference);

  // 3. Distances to the finest relaxed shape and to the full one.
  std::vector<double> to_fine, to_full;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const Vec distances = distances_to(reference, solved[i].mesh);
    to_full.push_back(distances.mean());
    to_fine.push_back(distances_to(solved.back(), solved[i].mesh).mean());
    run.metric("mean_distance_to_full_" + names[i], to_full[i], "1");
    run.metric("max_distance_to_full_" + names[i], distances.maxCoeff(), "1");
    if (i + 1 < names.size()) run.metric("mean_distance_to_fine_" + names[i], to_fine[i], "1");
    write_vtp(run.path(names[i] + ".vtp"), solved[i].mesh,
              {{{"distance [1]", distances}}, {{"compression [1]", solved[i].compression}}});
  }
  run.metric("error_ratio_medium", to_fine[0] / to_fine[1], "1");
  run.metric("error_ratio_full", to_full[0] / to_full[2], "1");
  write_vtp(run.path("full.vtp"), reference.mesh);
}

}  // namespace

int main(int argc, char** argv)
{
  return softform::run_experiment(argc, argv,
                                  {"fig_6_11",
                                   "6.7",
                                   "The relaxed energy is accurate on coarse meshes and far faster than the full one.",
                                   {0.2, 8}},
                                  compare_energies);
}
