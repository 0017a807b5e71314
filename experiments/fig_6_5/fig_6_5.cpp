// Purpose: two discs sewn together and inflated (thesis 6.5.1, figure 6.5), the foil balloon whose seam shrinks and
// wrinkles. Nearly inextensible, it is the Mylar balloon, which has a closed form (Paulsen 1994, The American
// Mathematical Monthly 101). With it a softer pair of discs, and the square airbag of the membrane literature (Contri
// and Schrefler 1988, International Journal for Numerical Methods in Engineering 26).
// Claim: the relaxed energy (6.6) gives the shape on coarse meshes in few Newton iterations.

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "softform/experiment/experiment.hpp"
#include "softform/experiment/run.hpp"
#include "softform/inflatables/inflatable.hpp"
#include "softform/inflatables/pillow.hpp"
#include "softform/io/vtk_io.hpp"
#include "softform/materials/tension_field.hpp"
#include "softform/mesh/disc.hpp"

namespace {

using namespace softform;

// Of two discs of radius 1 m, inextensible along their meridians. K is the lemniscate's integral of 1/sqrt(1 - u^4).
struct MylarBalloon {
  double radius;           // [m]
  double thickness_ratio;  // largest thickness over diameter
  double volume;           // [m^3]
};

MylarBalloon mylar_balloon()
{
  const double gamma = std::tgamma(0.25), pi = std::numbers::pi;
  const double K = gamma * gamma / (4 * std::sqrt(2 * pi));
  const double radius = 1 / K;  // the meridian, of length radius K, is the disc's radius
  return {radius, pi / (4 * K), 2 * pi * radius * radius * radius * K / 3};
}

struct Inflated {
  PanelLayout layout;
  Equilibrium equilibrium;
  double volume = 0;
  Vec compression;

  Positions nodes() const { return unflatten(equilibrium.x); }
  double height() const { return nodes().col(2).maxCoeff() - nodes().col(2).minCoeff(); }
};

Inflated inflate_layout(PanelLayout layout, double kappa, double thickness, double pressure, double residual)
{
  Inflated inflated{std::move(layout), {}, 0, {}};
  const Inflatable inflatable(inflated.layout, std::make_shared<TensionField>(kappa, 0, residual), thickness, pressure);
  const Vec flat = flat_vector(inflated.layout);
  SparseFactorization factorization;
  inflated.equilibrium = inflate(inflatable, flat, flatten(inflated.layout.nodes), factorization);
  inflated.volume = inflatable.volume().value(inflated.equilibrium.x);
  inflated.compression = inflatable.compression(inflated.equilibrium.x, flat);
  return inflated;
}

Inflated inflate_disc(const TriangleMesh& sheet, double stiffness, double residual_bias)
{
  // kappa h = stiffness p a with a = 1 m; the residual stiffness pulls with residual_bias p a.
  constexpr double thickness = 1e-4, pressure = 1000;
  return inflate_layout(pillow(sheet), stiffness * pressure / thickness, thickness, pressure,
                        residual_bias / stiffness);
}

double seam_radius(const Inflated& disc)
{
  double sum = 0;
  const std::vector<int>& rim = disc.layout.seams[0].sides[0].vertices;
  for (const int v : rim) sum += disc.nodes().row(disc.layout.node_of[std::size_t(v)]).head<2>().norm();
  return sum / double(rim.size());
}

void write_surface(const Run& run, const std::string& file, const Inflated& inflated)
{
  const TriangleMesh mesh{inflated.nodes(), node_triangles(inflated.layout)};
  write_vtp(run.path(file), mesh, {{}, {{"compression [1]", inflated.compression}}});
}

void report(Run& run, const std::string& name, const Inflated& disc, const MylarBalloon& exact)
{
  run.metric("elements_" + name, disc.layout.triangle_count(), "1");
  run.metric("volume_ratio_" + name, disc.volume / exact.volume, "1");
  run.metric("radius_ratio_" + name, seam_radius(disc) / exact.radius, "1");
  run.metric("thickness_ratio_" + name, disc.height() / (2 * seam_radius(disc)) / exact.thickness_ratio, "1");
  run.metric("iterations_" + name, disc.equilibrium.iterations, "1");
  run.metric("max_residual_" + name, disc.equilibrium.residual, "1");
}

void inflate_foil_balloons(Run& run)
{
  // 1. The closed form.
  const MylarBalloon exact = mylar_balloon();
  run.metric("analytic_radius", exact.radius, "m");
  run.metric("analytic_thickness_ratio", exact.thickness_ratio, "1");
  run.metric("analytic_volume", exact.volume, "m^3");

  // 2. Discs with meridian edges, finer and finer: kappa h / (p a) = 1000, a residual of 1e-4 p a.
  constexpr double stiffness = 1000, residual_bias = 1e-4;
  auto& convergence = run.series("convergence", {{"elements", "1"},
                                                 {"edge", "m"},
                                                 {"volume_error", "1"},
                                                 {"radius_error", "1"},
                                                 {"thickness_error", "1"},
                                                 {"iterations", "1"}});
  const std::vector<int> rings = run.by_size<std::vector<int>>({7, 14, 28}, {7, 14, 28, 56});
  std::vector<double> volume_errors;
  for (const int n : rings) {
    run.step(fmt::format("disc with {} rings", n));
    Inflated disc;
    run.time(fmt::format("{}_rings", n),
             [&] { disc = inflate_disc(spoked_disc(1, 45 * n / 14, n), stiffness, residual_bias); });
    volume_errors.push_back(disc.volume / exact.volume - 1);
    convergence.add_row(
        {double(disc.layout.triangle_count()), 1.0 / n, volume_errors.back(), seam_radius(disc) / exact.radius - 1,
         disc.height() / (2 * seam_radius(disc)) / exact.thickness_ratio - 1, double(disc.equilibrium.iterations)});
    if (n != 28) continue;
    report(run, "spokes", disc, exact);
    run.trace("trace", disc.equilibrium.report.trace);
    write_surface(run, "balloon.vtp", disc);
    write_vtp(run.path("sheet.vtp"), spoked_disc(1, 90, 28));
  }
  run.metric("volume_order", std::log2(std::abs(volume_errors[0] / volume_errors[2])) / 2, "1");

  // 3. A mesh whose edges do not follow the wrinkles: the volume converges all the same.
  if (run.is_paper()) {
    run.step("disc without spokes");
    report(run, "unstructured", inflate_disc(disc(1, 28), stiffness, residual_bias), exact);
  }

  // 4. A softer foil, p R / (E h) = 1e-3 with E = 6 kappa.
  run.step("disc pair of 12k triangles");
  report(run, "soft", inflate_disc(spoked_disc(1, 102, 30), 1000.0 / 6, residual_bias), exact);
  if (run.is_paper()) report(run, "soft_unstructured", inflate_disc(disc(1, 32), 1000.0 / 6, residual_bias), exact);

  // 5. The square airbag: diagonal 1.2 m, E = 588 MPa, 0.6 mm, 5 kPa.
  run.step("square airbag");
  const double edge = 1.2 / std::sqrt(2.0);
  auto& airbags = run.series("airbag", {{"elements", "1"}, {"centre", "m"}, {"iterations", "1"}});
  for (const int cells : run.by_size<std::vector<int>>({16, 32}, {16, 32, 64})) {
    const Inflated airbag = inflate_layout(pillow(rectangle(edge, edge, cells, cells)), 588e6 / 6, 0.6e-3, 5e3, 1e-5);
    airbags.add_row(
        {double(airbag.layout.triangle_count()), airbag.height() / 2, double(airbag.equilibrium.iterations)});
    if (cells == 32) {
      run.metric("airbag_centre", airbag.height() / 2, "m");
      run.metric("airbag_iterations", airbag.equilibrium.iterations, "1");
      write_surface(run, "airbag.vtp", airbag);
      write_vtp(run.path("square.vtp"), rectangle(edge, edge, cells, cells));
    }
  }
}

}  // namespace

int main(int argc, char** argv)
{
  return softform::run_experiment(argc, argv,
                                  {"fig_6_5",
                                   "6.5.1",
                                   "The relaxed energy gives the foil balloon's shape on coarse meshes, in few "
                                   "Newton iterations.",
                                   {0.1, 1}},
                                  inflate_foil_balloons);
}
