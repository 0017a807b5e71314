// Purpose: the membrane model of 3.1.4 and 4.3.1 on the one balloon whose answer is known. A sphere is inflated by
// volume control, through the pressure's limit point, with each of the five materials of appendix A, and the pressure
// is compared with the closed form
//     p = 4 (h/R) (1/L - 1/L^7) (dPsi/dI1 + L^2 dPsi/dI2)
// on meshes that are refined. Claim: second order in the mesh size for every material.
// With Ogden's material the stable balloon of given volume is no sphere for some stretches behind the limit point
// (Haughton and Ogden 1978): those states are counted and left out of the comparison.

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

struct State {
  double pressure;     // [Pa]
  double asphericity;  // standard deviation of the radius over its mean
};

double asphericity(const Vec& x)
{
  const Positions positions = unflatten(x);
  const Vec radii = (positions.rowwise() - positions.colwise().mean()).rowwise().norm();
  return std::sqrt((radii.array() - radii.mean()).square().mean()) / radii.mean();
}

// States of an irregular sphere at the stretches, one after the other along the path. NaN where there is none.
std::vector<State> inflate(const std::shared_ptr<const Material>& material, int vertex_count,
                           const std::vector<double>& stretches)
{
  const TriangleMesh mesh = irregular_sphere(radius, vertex_count);
  const Membrane membrane(mesh.triangles, vertex_count, material, Vec::Constant(mesh.triangle_count(), thickness));
  const PressurizedMembrane balloon(membrane, flatten(mesh.vertices));
  SparseFactorization factorization;
  Equilibrium state;
  state.x = balloon.rest_positions();
  double last_stretch = 1;
  std::vector<State> found;
  for (const double stretch : stretches) {
    const double volume = balloon.rest_volume() * std::pow(stretch, 3);
    state = solve_at_volume(balloon, volume, stretch / last_stretch * state.x, state.pressure, factorization);
    last_stretch = stretch;
    found.push_back({state.report.converged() ? state.pressure : std::nan(""), asphericity(state.x)});
  }
  return found;
}

// Beyond this the stable shape is no sphere, and the closed form says nothing of it.
constexpr double largest_asphericity = 2e-2;

double largest_error(const Material& material, const std::vector<double>& stretches, const std::vector<State>& found)
{
  double error = 0;
  for (std::size_t k = 0; k < stretches.size(); ++k) {
    if (found[k].asphericity > largest_asphericity) continue;
    const double exact = spherical_balloon_pressure(material, thickness, radius, stretches[k]);
    const double relative = std::abs(found[k].pressure / exact - 1);
    if (!(relative <= error)) error = relative;  // keeps NaN
  }
  return error;
}

void compare_with_closed_form(Run& run)
{
  // 1. Stretches on both sides of the limit points (near 1.4 for a neo-Hookean material).
  std::vector<double> stretches;
  const int steps = run.by_size(20, 40);
  for (int k = 1; k <= steps; ++k) stretches.push_back(1 + 2.0 * k / steps);
  const std::vector<int> sizes = run.by_size(std::vector{250, 1000}, std::vector{500, 2000, 8000});

  for (const std::string& name : materials) {
    // 2. The path on every mesh.
    const std::shared_ptr<const Material> material = load_material(name);
    std::vector<double> errors;
    std::vector<State> states;
    for (const int size : sizes) {
      run.step(fmt::format("{}, {} vertices", name, size));
      states = inflate(material, size, stretches);
      errors.push_back(largest_error(*material, stretches, states));
    }
    // 3. The curve of the finest mesh beside the closed form, and the order of convergence in the mesh size.
    auto& curve =
        run.series(name, {{"stretch", "1"}, {"pressure", "Pa"}, {"analytic_pressure", "Pa"}, {"asphericity", "1"}});
    for (std::size_t k = 0; k < stretches.size(); ++k)
      curve.add_row({stretches[k], states[k].pressure,
                     spherical_balloon_pressure(*material, thickness, radius, stretches[k]), states[k].asphericity});
    const double refinement = 0.5 * std::log2(double(sizes.back()) / sizes[sizes.size() - 2]);
    run.metric("relative_error_" + name, errors.back(), "1");
    run.metric("order_" + name, std::log2(errors[errors.size() - 2] / errors.back()) / refinement, "1");
    const auto is_aspherical = [](const State& state) { return state.asphericity > largest_asphericity; };
    run.metric("aspherical_share_" + name,
               double(std::count_if(states.begin(), states.end(), is_aspherical)) / double(states.size()), "1");
  }
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
      compare_with_closed_form);
}
