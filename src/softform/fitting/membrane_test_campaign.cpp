#include "softform/fitting/membrane_test_campaign.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <random>
#include <utility>

#include <fmt/format.h>

#include "softform/core/error.hpp"
#include "softform/equilibrium/volume_control.hpp"
#include "softform/fitting/membrane_test.hpp"
#include "softform/mesh/disc.hpp"
#include "softform/mesh/distance.hpp"

namespace softform {
namespace {

void check(const CampaignOptions& options)
{
  if (options.volumes.empty() || options.volumes.front() <= 0 || options.samples < 1 || options.thicknesses.empty())
    throw InputError("a campaign needs a thickness, a sample and a positive volume: give one of each or more");
  if (std::adjacent_find(options.volumes.begin(), options.volumes.end(), std::greater_equal<>()) !=
      options.volumes.end())
    throw InputError("the volumes of a campaign must rise: sort them");
}

// The true sheet at a nominal volume, and how it changes with the volume.
struct TrueState {
  double volume, pressure, dp_dV;
  Vec x, dx_dV;
};

std::vector<TrueState> true_states(const ClampedSheet& sheet, const std::vector<double>& volumes)
{
  SparseFactorization factorization;
  std::vector<double> faceted;
  for (const double volume : volumes) faceted.push_back(faceted_volume(sheet, volume));
  const std::vector<Equilibrium> states = inflate(sheet, faceted, factorization);
  std::vector<TrueState> found;
  for (std::size_t i = 0; i < states.size(); ++i) {
    if (!states[i].report.converged())
      throw InputError(fmt::format("the sheet does not reach {:.3g} m^3: {}", volumes[i], states[i].report.message));
    TrueState state{volumes[i], states[i].pressure, 0, {}, {}};
    state.x = solve_at_volume(sheet.balloon(), faceted[i], states[i].x, states[i].pressure, factorization, {},
                              sheet.clamp(), &state.dx_dV, &state.dp_dV)
                  .x;
    found.push_back(std::move(state));
  }
  return found;
}

class Instruments {
 public:
  explicit Instruments(const CampaignOptions& options) : options_(options), generator_(options.seed) {}

  double gaussian(double standard_error) { return std::normal_distribution<double>(0, standard_error)(generator_); }
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(generator_); }

  // Points of the sheet with their errors, without those that a scanner misses.
  Positions scan(const TriangleMesh& sheet)
  {
    const Positions points = sample_surface(sheet, options_.scan_points);
    const std::vector<ClosestPoint> feet = SurfaceDistance(sheet).closest_points(points);
    std::array<Vec3, 2> holes;
    for (Vec3& hole : holes)
      hole = points.row(static_cast<Eigen::Index>(uniform(0, static_cast<double>(points.rows()))));
    Positions seen(points.rows(), 3);
    Eigen::Index count = 0;
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
      const Vec3 point = points.row(i);
      const auto in_hole = [&](const Vec3& hole) { return (point - hole).norm() < options_.hole_radius; };
      if (uniform(0, 1) < options_.lost_share || point.z() < options_.hidden_height ||
          feet[static_cast<std::size_t>(i)].normal.z() < -options_.steepest_undercut ||
          std::any_of(holes.begin(), holes.end(), in_hole))
        continue;
      const double error = options_.scan_error;
      seen.row(count++) = points.row(i) + Eigen::RowVector3d(gaussian(error), gaussian(error), gaussian(error));
    }
    return seen.topRows(count);
  }

 private:
  const CampaignOptions& options_;
  std::mt19937_64 generator_;
};

}  // namespace

std::vector<double> equal_volume_steps(double largest, int count)
{
  std::vector<double> volumes;
  for (int k = 1; k <= count; ++k) volumes.push_back(largest * k / count);
  return volumes;
}

Positions rim(double radius)
{
  constexpr int rings = 10;
  return disc(radius, rings).vertices.bottomRows(6 * rings);
}

std::vector<MembraneSample> simulate_campaign(const std::shared_ptr<const Material>& material,
                                              const CampaignOptions& options)
{
  check(options);
  constexpr double reference_thickness = 1e-3;
  const ClampedSheet sheet(options.radius, reference_thickness, options.rings, material);
  const std::vector<TrueState> states = true_states(sheet, options.volumes);
  Instruments instruments(options);
  std::vector<MembraneSample> samples;
  for (const double nominal : options.thicknesses) {
    for (int k = 0; k < options.samples; ++k) {
      const double tolerance = options.thickness_tolerance;
      const double thickness = nominal * (1 + instruments.uniform(-tolerance, tolerance));
      MembraneSample sample{nominal, thickness * (1 + instruments.gaussian(options.thickness_error)), {}};
      for (const TrueState& state : states) {
        // A thousandth of the volume more or less: the tangent is exact enough.
        const double dV = state.volume * instruments.gaussian(options.volume_error);
        const double pressure = (state.pressure + dV * state.dp_dV) * thickness / reference_thickness;
        const TriangleMesh shape{unflatten(state.x + dV * state.dx_dV), sheet.mesh().triangles};
        sample.steps.push_back(
            {state.volume, pressure + instruments.gaussian(options.pressure_error), instruments.scan(shape)});
      }
      samples.push_back(std::move(sample));
    }
  }
  return samples;
}

ScannedSheet measure_scan(const RbfImplicit& surface, double radius, double volume)
{
  constexpr int rings = 20;
  const TriangleMesh flat = disc(radius, rings);
  const Vec cap = spherical_cap(flat, radius, volume);
  Positions x = unflatten(cap);
  for (Eigen::Index i = 0; i < disc_vertex_count(rings - 1); ++i)
    x.row(i) = surface.project(x.row(i).transpose()).transpose();
  // The facets enclose less than the smooth surface: by the same fraction as those of the cap.
  const double faceting = enclosed_volume(cap, flat.triangles) / volume;
  const double area_ratio =
      surface_area(flatten(x), flat.triangles) / surface_area(flatten(flat.vertices), flat.triangles);
  return {std::sqrt(area_ratio), enclosed_volume(flatten(x), flat.triangles) / faceting};
}

}  // namespace softform
