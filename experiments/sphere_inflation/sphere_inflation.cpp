// Purpose: the membrane model of 3.1.4 and 4.3.1 on the one balloon whose answer is known. A sphere is inflated by
// volume control, through the pressure's limit point, with each of the five materials of appendix A, and the pressure
// is compared with the closed form
//     p = 4 (h/R) (1/L - 1/L^7) (dPsi/dI1 + L^2 dPsi/dI2)
// on meshes that are refined. Claim: second order in the mesh size for every material.

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "softform/balloons/spherical_balloon.hpp"
#include "softform/equilibrium/volume_control.hpp"
#include "softform/experiment/experiment.hpp"
#include "softform/experiment/run.hpp"
#include "softform/io/vtk_io.hpp"
#include "softform/materials/material_file.hpp"
#include "softform/mesh/shapes.hpp"

namespace {

using namespace softform;

constexpr double radius = 0.03;     // [m]
constexpr double thickness = 3e-4;  // [m]

const std::vector<std::string> materials{"st_venant_kirchhoff", "neo_hookean", "mooney_rivlin", "ogden_1972",
                                         "silicone"};

// Pressures [Pa] of an irregular sphere at the stretches, one after the other along the path.
std::vector<double> pressures(const std::shared_ptr<const Material>& material, int vertex_count,
                              const std::vector<double>& stretches)
{
  const TriangleMesh mesh = irregular_sphere(radius, vertex_count);
  const Membrane membrane(mesh.triangles, vertex_count, material, Vec::Constant(mesh.triangle_count(), thickness));
  const PressurizedMembrane balloon(membrane, flatten(mesh.vertices));
  SparseFactorization factorization;
  Equilibrium state;
  state.x = balloon.rest_positions();
  double last_stretch = 1;
  std::vector<double> found;
  for (const double stretch : stretches) {
    const double volume = balloon.rest_volume() * std::pow(stretch, 3);
    state = solve_at_volume(balloon, volume, stretch / last_stretch * state.x, state.pressure, factorization);
    last_stretch = stretch;
    found.push_back(state.report.converged() ? state.pressure : std::nan(""));
  }
  return found;
}

double largest_error(const Material& material, const std::vector<double>& stretches, const std::vector<double>& found)
{
  double error = 0;
  for (std::size_t k = 0; k < stretches.size(); ++k) {
    const double exact = spherical_balloon_pressure(material, thickness, radius, stretches[k]);
    const double relative = std::abs(found[k] / exact - 1);
    if (!(relative <= error)) error = relative;  // keeps NaN
  }
  return error;
}

void run_experiment_body(Run& run)
{
  // 1. Stretches on both sides of the limit points (near 1.4 for a neo-Hookean material).
  std::vector<double> stretches;
  for (double L = 1.05; L < 3.001; L += 0.05) stretches.push_back(L);
  const std::vector<int> sizes = run.by_size(std::vector{250, 1000}, std::vector{500, 2000, 8000});

  for (const std::string& name : materials) {
    // 2. The pressure curve on every mesh.
    const std::shared_ptr<const Material> material = load_material(name);
    std::vector<double> errors, pressure;
    for (const int size : sizes) {
      run.step(fmt::format("{}, {} vertices", name, size));
      pressure = pressures(material, size, stretches);
      errors.push_back(largest_error(*material, stretches, pressure));
    }
    // 3. The curve of the finest mesh beside the closed form, and the order of convergence in the mesh size.
    auto& curve = run.series(name, {{"stretch", "1"}, {"pressure", "Pa"}, {"analytic_pressure", "Pa"}});
    for (std::size_t k = 0; k < stretches.size(); ++k)
      curve.add_row(
          {stretches[k], pressure[k], spherical_balloon_pressure(*material, thickness, radius, stretches[k])});
    const double refinement = 0.5 * std::log2(double(sizes.back()) / sizes[sizes.size() - 2]);
    run.metric("relative_error_" + name, errors.back(), "1");
    run.metric("order_" + name, std::log2(errors[errors.size() - 2] / errors.back()) / refinement, "1");
  }
  run.metric("vertices", sizes.back(), "1");
}

}  // namespace

int main(int argc, char** argv)
{
  return softform::run_experiment(
      argc, argv,
      {"sphere_inflation",
       "3.1.4, 4.3.1",
       "An inflated sphere follows the closed-form pressure of every material, through its limit point.",
       {0.2, 2}},
      run_experiment_body);
}
