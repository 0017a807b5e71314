// Purpose: where a foil balloon wrinkles (thesis 6.5.2, figure 6.6): the full neo-Hookean energy (6.3) on a fine mesh,
// which folds, beside the compression field of the relaxed energy (6.6) on a coarse one, which stays smooth.
// Claim: the compressed regions are the same.

#include <cmath>
#include <random>

#include "softform/experiment/experiment.hpp"
#include "softform/experiment/run.hpp"
#include "softform/inflatables/inflatable.hpp"
#include "softform/inflatables/pillow.hpp"
#include "softform/io/vtk_io.hpp"
#include "softform/materials/registry.hpp"
#include "softform/materials/tension_field.hpp"
#include "softform/mesh/disc.hpp"
#include "softform/mesh/distance.hpp"

namespace {

using namespace softform;

// Discs of radius 1 m, kappa h / (p a) = 200; a residual stiffness that pulls with 1e-3 p a.
constexpr double kappa = 2e6, thickness = 1e-4, pressure = 1, residual = 5e-6;

Equilibrium inflate_from(const Inflatable& inflatable, const PanelLayout& layout, const Vec& x0)
{
  SparseFactorization factorization;
  return inflate(inflatable, flat_vector(layout), x0, factorization);
}

// The coarse front triangle that each fine front triangle lies in; -1 on the back. Both sheets are the unit disc.
std::vector<int> patches(const TriangleMesh& coarse, const TriangleMesh& fine, const PanelLayout& fine_layout)
{
  const SurfaceDistance sheet(coarse);
  std::vector<int> patch(std::size_t(fine_layout.triangle_count()), -1);
  for (int t = 0; t < fine.triangle_count(); ++t)
    patch[std::size_t(t)] = sheet.closest(fine.vertices(fine.triangles.row(t), Eigen::all).colwise().mean()).triangle;
  return patch;
}

// Areas of the intersection over the union of {compression > level} in both fields.
double overlap(const Vec& areas, const Vec& a, const Vec& b, double level)
{
  const auto in_a = a.array() > level, in_b = b.array() > level;
  return (in_a && in_b).select(areas, 0.0).sum() / (in_a || in_b).select(areas, 0.0).sum();
}

double correlation(const Vec& areas, const Vec& a, const Vec& b)
{
  const double total = areas.sum(), mean_a = areas.dot(a) / total, mean_b = areas.dot(b) / total;
  const Vec x = a.array() - mean_a, y = b.array() - mean_b, w = areas / total;
  return w.dot(x.cwiseProduct(y)) / std::sqrt(w.dot(x.cwiseAbs2()) * w.dot(y.cwiseAbs2()));
}

void compare_wrinkles(Run& run)
{
  constexpr int rings = 6;
  const TriangleMesh coarse = disc(1, rings), fine = disc(1, 4 * rings);
  const PanelLayout coarse_layout = pillow(coarse), fine_layout = pillow(fine);
  const auto relaxed = std::make_shared<TensionField>(kappa, 0, residual);
  const std::shared_ptr<const Material> full = make_material("neo_hookean", {{"mu", 2 * kappa}});

  // 1. The relaxed energy on the coarse mesh: compression, triangle by triangle.
  run.step("relaxed energy, coarse");
  const Inflatable coarse_relaxed(coarse_layout, relaxed, thickness, pressure);
  Equilibrium smooth;
  run.time("relaxed", [&] { smooth = inflate_from(coarse_relaxed, coarse_layout, flatten(coarse_layout.nodes)); });
  const Vec all = coarse_relaxed.compression(smooth.x, flat_vector(coarse_layout));
  const Vec predicted = all.head(coarse.triangle_count());

  // 2. The full energy on the fine mesh. From the flat sheets it locks halfway; so it starts from its own relaxed
  // solution, nodes off by a hundredth of an edge, for wrinkles need a beginning.
  run.step("full energy, fine");
  const Vec unwrinkled =
      inflate_from(Inflatable(fine_layout, relaxed, thickness, pressure), fine_layout, flatten(fine_layout.nodes)).x;
  std::mt19937 random(run.seed());
  std::normal_distribution<double> normal(0, 0.01 * mean_edge_length(fine));
  const Vec start = unwrinkled.unaryExpr([&](double x) { return x + normal(random); });
  const Inflatable fine_full(fine_layout, full, thickness, pressure);
  Equilibrium wrinkled;
  run.time("full", [&] { wrinkled = inflate_from(fine_full, fine_layout, start); });

  // 3. Its mean compression on the coarse triangles of the front.
  const std::vector<int> patch = patches(coarse, fine, fine_layout);
  const Vec resolved =
      fine_full.patch_compression(wrinkled.x, flat_vector(fine_layout), patch, coarse.triangle_count());
  Vec areas(coarse.triangle_count());
  for (int t = 0; t < coarse.triangle_count(); ++t)
    areas[t] =
        TriangleEdges(flatten(coarse.vertices), coarse.triangles(t, 0), coarse.triangles(t, 1), coarse.triangles(t, 2))
            .products()
            .area();
  run.metric("overlap_5_percent", overlap(areas, predicted, resolved, 0.05), "1");
  run.metric("overlap_10_percent", overlap(areas, predicted, resolved, 0.1), "1");
  run.metric("correlation", correlation(areas, predicted, resolved), "1");
  run.metric("mean_compression_relaxed", areas.dot(predicted) / areas.sum(), "1");
  run.metric("mean_compression_full", areas.dot(resolved) / areas.sum(), "1");
  run.metric("volume_ratio", fine_full.volume().value(wrinkled.x) / coarse_relaxed.volume().value(smooth.x), "1");
  run.metric("elements_relaxed", coarse_layout.triangle_count(), "1");
  run.metric("elements_full", fine_layout.triangle_count(), "1");
  run.metric("iterations_relaxed", smooth.iterations, "1");
  run.metric("iterations_full", wrinkled.iterations, "1");
  run.metric("max_residual_relaxed", smooth.residual, "1");
  run.metric("max_residual_full", wrinkled.residual, "1");

  // 4. The front of both.
  Vec shown(fine.triangle_count());
  for (int t = 0; t < fine.triangle_count(); ++t) shown[t] = resolved[patch[std::size_t(t)]];
  write_vtp(run.path("full.vtp"), {unflatten(wrinkled.x), node_triangles(fine_layout).topRows(shown.size())},
            {{}, {{"compression [1]", shown}}});
  write_vtp(run.path("relaxed.vtp"), {unflatten(smooth.x), node_triangles(coarse_layout).topRows(predicted.size())},
            {{}, {{"compression [1]", predicted}}});
}

}  // namespace

int main(int argc, char** argv)
{
  return softform::run_experiment(
      argc, argv,
      {"fig_6_6", "6.5.2", "The compression field of the relaxed energy is where the full energy wrinkles.", {0.2, 5}},
      compare_wrinkles);
}
