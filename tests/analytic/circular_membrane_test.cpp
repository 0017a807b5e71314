// An inflated circular membrane: the differential equations against published-precision values, the finite elements
// against the differential equations.

#include <cmath>
#include <memory>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "softform/equilibrium/volume_control.hpp"
#include "softform/fitting/circular_membrane.hpp"
#include "softform/fitting/membrane_test.hpp"
#include "softform/materials/registry.hpp"
#include "softform/mesh/disc.hpp"
#include "support/expect_input_error.hpp"

namespace softform::testing {
namespace {

constexpr double radius = 0.03, thickness = 5e-4;  // [m]
constexpr double mu = 0.35e6;                      // [Pa]

std::shared_ptr<const Material> neo_hookean() { return make_material("neo_hookean", {{"mu", mu}}); }

// C01/C10 = 0.1
std::shared_ptr<const Material> mooney_rivlin()
{
  return make_material("mooney_rivlin", {{"mu_1", mu}, {"mu_2", 0.1 * mu}});
}

TEST(Disc, IsFlatCircularAndOfGoodTriangles)
{
  const TriangleMesh mesh = disc(radius, 12);
  ASSERT_EQ(mesh.vertex_count(), disc_vertex_count(12));
  ASSERT_EQ(mesh.triangle_count(), 6 * 12 * 12);
  for (int i = 0; i < 72; ++i) EXPECT_NEAR(mesh.vertices.row(mesh.vertex_count() - 72 + i).norm(), radius, 1e-15);
  // A regular polygon of 72 corners.
  EXPECT_NEAR(surface_area(flatten(mesh.vertices), mesh.triangles), 36 * radius * radius * std::sin(M_PI / 36), 1e-15);
  double smallest_sine = 1;
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const auto corner = [&](int j) { return Vec3(mesh.vertices.row(mesh.triangles(t, (k + j) % 3))); };
      const Vec3 u = corner(1) - corner(0), v = corner(2) - corner(0);
      smallest_sine = std::min(smallest_sine, u.cross(v).z() / (u.norm() * v.norm()));  // negative when turned over
    }
  }
  EXPECT_GT(smallest_sine, std::sin(40 * M_PI / 180));
  test::expect_input_error([] { disc(radius, 1); }, {"2 rings"});
  test::expect_input_error([] { disc(-radius, 4); }, {"positive radius"});
}

struct Reference {
  double stretch, pressure, height, volume;  // p a/(mu h) with mu at rest, height/a, V/a^3
};

void expect_reference(const Material& material, const Reference& reference)
{
  const InflatedCircle found = inflated_circle(material, thickness, radius, reference.stretch);
  EXPECT_NEAR(found.pressure * radius / (material.shear_modulus() * thickness), reference.pressure, 1e-7);
  EXPECT_NEAR(found.height / radius, reference.height, 1e-7);
  EXPECT_NEAR(found.volume / std::pow(radius, 3), reference.volume, 1e-7);
}

TEST(CircularMembrane, AgreesWithAnIndependentShootingSolution)
{
  expect_reference(*neo_hookean(), {1.2, 0.99925183, 0.53097607, 0.95315151});
  expect_reference(*neo_hookean(), {2.0, 1.86955475, 1.08306716, 2.46651098});
  expect_reference(*neo_hookean(), {3.0, 1.80792210, 1.48884643, 4.18624450});
  expect_reference(*mooney_rivlin(), {2.0, 2.24590074, 1.16112516, 2.83320307});
  test::expect_input_error([] { inflated_circle(*neo_hookean(), thickness, radius, 1); }, {"exceed 1"});
}

// Relative errors of a sheet inflated to the volume of the exact solution.
struct Errors {
  double pressure, height, volume, pole_stretch;
};

std::vector<Errors> errors(const std::shared_ptr<const Material>& material, int rings,
                           const std::vector<double>& stretches)
{
  std::vector<InflatedCircle> exact;
  std::vector<double> volumes;
  for (const double stretch : stretches) {
    exact.push_back(inflated_circle(*material, thickness, radius, stretch));
    volumes.push_back(exact.back().volume);
  }
  const ClampedSheet sheet(radius, thickness, rings, material);
  SparseFactorization factorization;
  const std::vector<Equilibrium> states = inflate(sheet, volumes, factorization);
  EXPECT_EQ(states.size(), volumes.size());
  std::vector<Errors> found;
  for (std::size_t k = 0; k < states.size(); ++k) {
    const auto& state = states[k];
    EXPECT_TRUE(state.report.converged()) << state.report.message;
    Vec dx_dV;
    solve_at_volume(sheet.balloon(), volumes[k], state.x, state.pressure, factorization, {}, sheet.clamp(), &dx_dV);
    const double height = sheet.height(state.x);
    const double volume_at_exact_height = volumes[k] + (exact[k].height - height) / dx_dV[2];
    found.push_back({state.pressure / exact[k].pressure - 1, height / exact[k].height - 1,
                     volume_at_exact_height / volumes[k] - 1, sheet.pole_stretch(state.x) / stretches[k] - 1});
  }
  return found;
}

// 4921 vertices.
TEST(ClampedSheet, IsWithinTwoThousandthsOfTheExactSolution)
{
  for (const auto& material : {neo_hookean(), mooney_rivlin()}) {
    for (const Errors& found : errors(material, 40, {1.2, 2.0, 3.0})) {
      EXPECT_LT(std::abs(found.pressure), 2e-3) << material->model();
      EXPECT_LT(std::abs(found.height), 2e-3) << material->model();
      EXPECT_LT(std::abs(found.volume), 2e-3) << material->model();
      EXPECT_LT(std::abs(found.pole_stretch), 2e-3) << material->model();
    }
  }
}

TEST(ClampedSheet, ConvergesWithSecondOrder)
{
  for (const auto& material : {neo_hookean(), mooney_rivlin()}) {
    const Errors coarse = errors(material, 8, {2}).front(), fine = errors(material, 16, {2}).front();
    const auto order = [](double e, double f) { return std::log2(std::abs(e / f)); };
    EXPECT_NEAR(order(coarse.pressure, fine.pressure), 2, 0.25) << material->model();
    EXPECT_NEAR(order(coarse.height, fine.height), 2, 0.25) << material->model();
    EXPECT_NEAR(order(coarse.volume, fine.volume), 2, 0.25) << material->model();
  }
}

// The enclosed volume of an open sheet is that of the closed surface that the plane of its clamp completes.
TEST(ClampedSheet, VolumeIsThatAboveTheClamp)
{
  const ClampedSheet sheet(radius, thickness, 40, neo_hookean());
  for (const double volume : {1e-5, 4e-5, 2e-4})
    EXPECT_NEAR(sheet.balloon().volume().value(spherical_cap(sheet.mesh(), radius, volume)) / volume, 1, 3e-3);
}

}  // namespace
}  // namespace softform::testing
