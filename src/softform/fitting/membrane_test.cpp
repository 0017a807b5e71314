#include "softform/fitting/membrane_test.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "softform/equilibrium/volume_control.hpp"
#include "softform/mesh/disc.hpp"

namespace softform {

ClampedSheet::ClampedSheet(double radius, double thickness, int rings, std::shared_ptr<const Material> material)
    : radius_(radius), mesh_(disc(radius, rings))
{
  membrane_ = std::make_shared<Membrane>(mesh_.triangles, mesh_.vertex_count(), std::move(material),
                                         Vec::Constant(mesh_.triangle_count(), thickness));
  balloon_ = std::make_shared<PressurizedMembrane>(*membrane_, flatten(mesh_.vertices));
  clamp_.free.setOnes(3 * mesh_.vertex_count());
  clamp_.free.tail(3 * 6 * rings).setZero();
}

// The cap of height h has the volume pi h (3 a^2 + h^2)/6; the cubic in h has one real root.
Vec spherical_cap(const TriangleMesh& flat_disc, double radius, double volume)
{
  const double a = radius;
  const double height = 2 * a * std::sinh(std::asinh(3 * volume / (std::numbers::pi * a * a * a)) / 3);
  const double sphere_radius = (a * a + height * height) / (2 * height), half_angle = 2 * std::atan(height / a);
  Positions x = flat_disc.vertices;
  for (auto row : x.rowwise()) {
    const double distance = row.norm();
    const double angle = half_angle * distance / a;
    if (distance > 0) row *= sphere_radius * std::sin(angle) / distance;
    row.z() = height - sphere_radius * (1 - std::cos(angle));
  }
  return flatten(x);
}

double faceted_volume(const ClampedSheet& sheet, double volume)
{
  return sheet.balloon().volume().value(spherical_cap(sheet.mesh(), sheet.radius(), volume));
}

double ClampedSheet::pole_stretch(ConstVec x) const
{
  const Triangles around_pole = mesh_.triangles.topRows(6);
  return std::sqrt(surface_area(x, around_pole) / surface_area(balloon_->rest_positions(), around_pole));
}

std::vector<Equilibrium> inflate(const ClampedSheet& sheet, const std::vector<double>& volumes,
                                 SparseFactorization& factorization)
{
  // A shallow dome resists as the cube of its height: the first state is a fair part of a hemisphere.
  double volume = std::min(volumes.front(), 0.3 * std::pow(sheet.radius(), 3));
  double step = volume;
  const double smallest_step = 1e-3 * step;
  NewtonOptions newton;
  newton.max_iterations = 40;  // rather half the step
  Vec dx_dV;
  double dp_dV = 0;
  Equilibrium state = solve_at_volume(sheet.balloon(), volume, spherical_cap(sheet.mesh(), sheet.radius(), volume), 0,
                                      factorization, newton, sheet.clamp(), &dx_dV, &dp_dV);
  std::vector<Equilibrium> found;
  while (state.report.converged()) {
    if (volume == volumes[found.size()]) {
      found.push_back(state);
      if (found.size() == volumes.size()) return found;
    }
    const double next_volume = std::min(volume + step, volumes[found.size()]), dV = next_volume - volume;
    Equilibrium next = solve_at_volume(sheet.balloon(), next_volume, state.x + dV * dx_dV, state.pressure + dV * dp_dV,
                                       factorization, newton, sheet.clamp(), &dx_dV, &dp_dV);
    if (next.report.converged()) {
      volume = next_volume;
      state = std::move(next);
      step *= 1.5;
    } else if (step > smallest_step) {
      step = dV / 2;
    } else {
      state = std::move(next);
    }
  }
  found.push_back(std::move(state));
  return found;
}

}  // namespace softform
