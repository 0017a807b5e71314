#include "softform/characters/pin_placement.hpp"

#include <algorithm>

#include "softform/mesh/planar_mesh.hpp"
#include "softform/optimizers/reduced_gauss_newton.hpp"

namespace softform {
namespace {

// True equilibria under the pins as they are, from the poses of the placement.
void settle(const PlanarSolid& body, const Vec& densities, const PinPlacementOptions& options, PinPlacement& placement)
{
  SparseFactorization factorization;
  placement.negative_eigenvalues = 0;
  placement.residual = 0;
  placement.is_settled = true;
  for (std::size_t i = 0; i < placement.positions.size(); ++i) {
    const LoadedSolid<2> potential(body, densities, {},
                                   pins_of_pose(body, placement.pins, i, options.weights.stiffness));
    const Equilibrium equilibrium =
        solve_equilibrium(potential, placement.positions[i], factorization, {}, options.held);
    SparseMatrix K;
    potential.hessian(equilibrium.x, K);
    options.held.project(K, K.diagonal().cwiseAbs().mean());
    placement.positions[i] = equilibrium.x;
    placement.negative_eigenvalues += count_negative_eigenvalues(std::move(K), factorization);
    placement.is_settled = placement.is_settled && equilibrium.report.converged();
    placement.residual = std::max(placement.residual, equilibrium.residual);
  }
}

}  // namespace

std::vector<Pin<2>> pins_of_pose(const PlanarSolid& body, const Pins& pins, std::size_t pose, double stiffness)
{
  const BoundaryField field(body);
  std::vector<Pin<2>> springs;
  for (std::size_t j = 0; j < pins.places.size(); ++j) {
    const std::vector<int> kernels = field.kernels(pins.places[j], pins.sides[j], field.radius());
    springs.push_back({spread_point(field.weights(pins.places[j], kernels)), pins.positions[pose][j], stiffness});
  }
  return springs;
}

Pins pins_from(const PlanarSolid& body, const PointActuation& actuation, const PinPlacementWeights& weights)
{
  const BoundaryField field(body);
  Pins pins;
  for (const int vertex : actuation.vertices) {
    pins.places.emplace_back(body.rest_positions().segment<2>(2 * vertex));
    pins.sides.push_back(field.normal(pins.places.back()));
  }
  for (std::size_t i = 0; i < actuation.positions.size(); ++i) {
    std::vector<Point<2>>& held = pins.positions.emplace_back();
    for (int j = 0; j < actuation.count(); ++j) {
      const Point<2> at = actuation.positions[i].segment<2>(2 * actuation.vertices[static_cast<std::size_t>(j)]);
      held.emplace_back(at + actuation.forces[i].segment<2>(2 * j) / weights.stiffness);
    }
  }
  return pins;
}

PinPlacement place_pins(const PlanarSolid& body, const Vec& densities, const std::vector<Vec>& targets,
                        const Pins& start, const std::vector<Vec>& start_positions, const PinPlacementOptions& options,
                        const IterationObserver& observer)
{
  const BoundaryField field(body);
  PinPlacement result{start, start_positions};
  settle(body, densities, options, result);
  ReducedGaussNewtonOptions method;
  method.constraint_weight = 1e5;  // forces of millinewtons matter here
  StopCriteria stop;
  stop.max_iterations = options.iterations_per_round;
  for (int round = 0; round < options.rounds; ++round) {
    const PinPlacementProgram program(body, densities, targets, result.pins, result.positions, options.weights,
                                      options.held);
    const double before = program.objective(program.initial_point());
    const Solution solution = ReducedGaussNewton(method).minimize(program, stop, observer);
    result.iterations += static_cast<int>(solution.report.trace.size());
    result.failed_equilibria += program.failed_equilibria();
    result.pins = program.pins(solution.z);
    for (int i = 0; i < static_cast<int>(targets.size()); ++i)
      result.positions[static_cast<std::size_t>(i)] = program.positions(solution.z, i);
    project_onto_boundary(field, result.pins.places, result.pins.sides);
    settle(body, densities, options, result);
    if (solution.report.termination == Termination::Interrupted ||
        !(solution.objective < (1 - options.least_gain) * before))
      break;
  }
  return result;
}

}  // namespace softform
