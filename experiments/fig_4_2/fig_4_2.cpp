// Purpose: the measuring set-up of thesis 4.3.2 (figure 4.2), simulated: a rubber sheet over a circular opening of 6
// cm, clamped at its edge, inflated in twelve steps; in each the pressure is read and the sheet is scanned. Four
// thicknesses, three samples each. The averaged extension ratio (4.8) comes from the scans.
// Claim: the simulated sheet follows the exact solution of the clamped circular membrane, with second order in the mesh
// size, and the extension read from a noisy, incomplete scan is that of the sheet.

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include <fmt/format.h>

#include "softform/equilibrium/volume_control.hpp"
#include "softform/experiment/experiment.hpp"
#include "softform/experiment/run.hpp"
#include "softform/fitting/circular_membrane.hpp"
#include "softform/fitting/membrane_test.hpp"
#include "softform/fitting/membrane_test_campaign.hpp"
#include "softform/fitting/membrane_test_curve.hpp"
#include "softform/io/vtk_io.hpp"
#include "softform/materials/material_file.hpp"
#include "softform/mesh/disc.hpp"

namespace {

using namespace softform;

constexpr double radius = 0.03;  // [m]
constexpr int loading_steps = 12;

struct Errors {
  double height = 0, volume = 0, pressure = 0;  // relative, the largest over the states
};

// A sheet of 0.5 mm inflated to the volumes of exact solutions of pole stretch 1.2 to 3.
Errors errors_against_exact(const std::shared_ptr<const Material>& material, int rings)
{
  const double thickness = 0.5e-3;
  std::vector<InflatedCircle> exact;
  std::vector<double> volumes;
  for (const double stretch : {1.2, 1.6, 2.0, 2.5, 3.0}) {
    exact.push_back(inflated_circle(*material, thickness, radius, stretch));
    volumes.push_back(exact.back().volume);
  }
  const ClampedSheet sheet(radius, thickness, rings, material);
  SparseFactorization factorization;
  const std::vector<Equilibrium> states = inflate(sheet, volumes, factorization);
  Errors largest;
  for (std::size_t k = 0; k < exact.size(); ++k) {
    if (k >= states.size() || !states[k].report.converged()) return {std::nan(""), std::nan(""), std::nan("")};
    Vec dx_dV;
    solve_at_volume(sheet.balloon(), volumes[k], states[k].x, states[k].pressure, factorization, {}, sheet.clamp(),
                    &dx_dV);
    const double height = sheet.height(states[k].x);
    largest.height = std::max(largest.height, std::abs(height / exact[k].height - 1));
    // Of the sheet that has the exact height.
    largest.volume = std::max(largest.volume, std::abs((exact[k].height - height) / dx_dV[2] / volumes[k]));
    largest.pressure = std::max(largest.pressure, std::abs(states[k].pressure / exact[k].pressure - 1));
  }
  return largest;
}

void check_against_exact(Run& run)
{
  const int rings = run.by_size(16, 40);
  for (const char* name : {"neo_hookean", "mooney_rivlin"}) {
    run.step(fmt::format("{} sheets of {} and {} vertices against the exact solution", name,
                         disc_vertex_count(rings / 2), disc_vertex_count(rings)));
    const std::shared_ptr<const Material> material = load_material(name);
    const Errors coarse = errors_against_exact(material, rings / 2), fine = errors_against_exact(material, rings);
    const std::string suffix = std::string("_") + name;
    run.metric("height_error" + suffix, fine.height, "1");
    run.metric("volume_error" + suffix, fine.volume, "1");
    run.metric("pressure_error" + suffix, fine.pressure, "1");
    run.metric("order_height" + suffix, std::log2(coarse.height / fine.height), "1");
    run.metric("order_pressure" + suffix, std::log2(coarse.pressure / fine.pressure), "1");
  }
}

// The meridian of the simulated sheets, and one of them with its scan, for the picture.
void draw_setup(Run& run, const CampaignOptions& options, const std::vector<MembraneSample>& samples)
{
  const double thickness = samples.front().thickness;
  const ClampedSheet sheet(radius, thickness, run.by_size(20, 40), load_material("silicone"));
  SparseFactorization factorization;
  const std::vector<Equilibrium> states = inflate(sheet, options.volumes, factorization);
  auto& profiles = run.series("profiles", {{"step"}, {"radius", "m"}, {"height", "m"}, {"pressure", "Pa"}});
  std::vector<std::pair<double, std::filesystem::path>> files;
  for (std::size_t i = 0; i < states.size(); ++i) {
    const Positions x = unflatten(states[i].x);
    for (int ring = 0; disc_vertex_count(ring) <= x.rows(); ++ring) {
      const Eigen::Index v = ring == 0 ? 0 : disc_vertex_count(ring - 1);
      profiles.add_row({double(i + 1), x(v, 0), x(v, 2), states[i].pressure});
    }
    files.emplace_back(states[i].pressure, fmt::format("sheet_{:02}.vtp", i + 1));
    write_vtp(run.path(files.back().second.string()), {x, sheet.mesh().triangles});
  }
  write_pvd(run.path("inflation.pvd"), files);
  constexpr int shown_step = 8;
  constexpr double half_width = 1e-3;  // of the slice about the cut [m]
  auto& scan = run.series("scan", {{"step"}, {"x", "m"}, {"y", "m"}, {"z", "m"}});
  for (const int step : {4, shown_step, 12})
    for (const auto& point : samples.front().steps[static_cast<std::size_t>(step - 1)].scan.rowwise())
      if (step == shown_step || std::abs(point.y()) < half_width)
        scan.add_row({double(step), point.x(), point.y(), point.z()});
}

// Extension against pressure, thickness by thickness, and how well the scans tell extension and volume.
void measure_samples(Run& run, const CampaignOptions& options, const std::vector<MembraneSample>& samples)
{
  const std::shared_ptr<const Material> silicone = load_material("silicone");
  auto& measured =
      run.series("extension", {{"thickness", "m"}, {"sample"}, {"step"}, {"extension"}, {"pressure", "Pa"}});
  auto& exact = run.series("exact", {{"thickness", "m"}, {"extension"}, {"pressure", "Pa"}});
  const InflationCurve truth = inflation_curve(*silicone, 1e-3, radius, options.volumes.back());
  for (const double thickness : options.thicknesses)
    for (Eigen::Index k = 0; k < truth.extension.size(); ++k)
      exact.add_row({thickness, truth.extension[k], truth.pressure[k] * thickness / 1e-3});

  double extension_error = 0, volume_error = 0, points = 0, scans = 0;
  for (std::size_t s = 0; s < samples.size(); ++s) {
    for (std::size_t i = 0; i < samples[s].steps.size(); ++i) {
      const LoadingStep& step = samples[s].steps[i];
      const RbfImplicit surface(step.scan, Vec3::Zero(), {.centres = run.by_size(400, 800)}, rim(radius));
      const ScannedSheet sheet = measure_scan(surface, radius, step.volume);
      measured.add_row({samples[s].nominal_thickness, double(s), double(i + 1), sheet.extension, step.pressure});
      const double true_extension = truth.extension_at_volume(step.volume);
      extension_error = std::max(extension_error, std::abs(sheet.extension / true_extension - 1));
      volume_error += std::pow(sheet.volume / step.volume - 1, 2);
      points += double(step.scan.rows());
      ++scans;
    }
  }
  run.metric("scans", scans, "1");
  run.metric("scan_points_mean", points / scans, "1");
  run.metric("extension_error", extension_error, "1");
  run.metric("scanned_volume_error", std::sqrt(volume_error / scans), "1");
}

void measure(Run& run)
{
  // 1. The simulated sheet against the differential equations of the axisymmetric membrane.
  check_against_exact(run);

  // 2. The campaign.
  run.step("the campaign: 4 thicknesses, 3 samples each, 12 loading steps");
  CampaignOptions options;
  options.radius = radius;
  options.volumes = equal_volume_steps(6 * std::pow(radius, 3), loading_steps);
  options.rings = run.by_size(24, 40);
  options.seed = run.seed();
  const std::vector<MembraneSample> samples = simulate_campaign(load_material("silicone"), options);
  run.metric("loading_steps", loading_steps, "1");
  run.metric("samples", double(samples.size()), "1");

  // 3. What the scans tell, and the picture.
  run.step("extensions from the scans");
  measure_samples(run, options, samples);
  draw_setup(run, options, samples);
}

}  // namespace

int main(int argc, char** argv)
{
  return softform::run_experiment(argc, argv,
                                  {"fig_4_2",
                                   "4.3.2",
                                   "Extension and pressure of clamped sheets, measured from scans in twelve loading "
                                   "steps; the sheet follows the exact clamped membrane.",
                                   {0.1, 0.5}},
                                  measure);
}
