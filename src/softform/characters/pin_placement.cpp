#include "softform/characters/pin_placement.hpp"

#include <algorithm>

#include <Eigen/Cholesky>
#include <Eigen/SparseLU>

#include "softform/mesh/planar_mesh.hpp"
#include "softform/optimizers/monitor.hpp"
#include "softform/optimizers/optimizer.hpp"

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

// Gauss-Newton steps on the equilibria, for the first variables z_x are determined by the others: the linearised
// constraints J_x dz_x + J_p dz_p = 0 are solved for dz_x, and what remains is a dense problem in few unknowns. Limp
// bodies need it exactly: with the constraints as a penalty, a step leaves the equilibria along modes that cost hardly
// any force, and nothing is left of its promise once they are restored.
class PlacementSteps {
 public:
  explicit PlacementSteps(const PinPlacementProgram& program) : program_(program) {}

  Solution minimize(const StopCriteria& stop, const IterationObserver& observer)
  {
    Solution solution;
    Monitor monitor(stop, observer, solution.report);
    const auto first = program_.restore(program_.initial_point());
    z_ = first ? *first : program_.initial_point();
    objective_ = program_.objective(z_);
    for (int k = 0;; ++k) {
      if (!first || !linearize()) {
        monitor.finish(Termination::Infeasible, "no equilibrium, or one without a tangent");
        break;
      }
      if (monitor.record({k, objective_, gradient_.cwiseAbs().maxCoeff(), 0, 0, 0})) break;
      if (!step() && monitor.finish(Termination::Stalled, "no step decreases the objective")) break;
    }
    solution.z = z_;
    solution.objective = objective_;
    return solution;
  }

 private:
  bool linearize()
  {
    const int states = program_.constraint_count(), designs = program_.variable_count() - states;
    Vec g;
    SparseMatrix H, J;
    program_.objective_gradient(z_, g);
    program_.gauss_newton_hessian(z_, H);
    program_.constraint_jacobian(z_, J);
    const SparseMatrix J_x = J.leftCols(states);
    Eigen::SparseLU<SparseMatrix> lu(J_x);
    if (lu.info() != Eigen::Success) return false;
    sensitivity_ = -lu.solve(Eigen::MatrixXd(J.rightCols(designs)));
    gradient_ = g.tail(designs) + sensitivity_.transpose() * g.head(states);
    hessian_ = Eigen::MatrixXd(H.bottomRightCorner(designs, designs)) +
               sensitivity_.transpose() * (SparseMatrix(H.topLeftCorner(states, states)) * sensitivity_);
    return gradient_.allFinite() && hessian_.allFinite();
  }

  // Levenberg-Marquardt; false when no damping gives a step that helps.
  bool step()
  {
    constexpr double growth = 4, largest = 1e8;
    for (; damping_ < largest; damping_ *= growth) {
      Eigen::MatrixXd damped = hessian_;
      damped.diagonal().array() += damping_ * hessian_.diagonal().mean();
      const Vec dp = -damped.ldlt().solve(gradient_);
      Vec dz(z_.size());
      dz << sensitivity_ * dp, dp;
      const auto next = program_.restore(z_ + dz);
      if (!next || !(program_.objective(*next) < objective_)) continue;
      z_ = *next;
      objective_ = program_.objective(z_);
      damping_ /= growth;
      return true;
    }
    return false;
  }

  const PinPlacementProgram& program_;
  Vec z_, gradient_;
  Eigen::MatrixXd sensitivity_, hessian_;  // dz_x/dz_p, and the reduced Gauss-Newton Hessian
  double objective_ = 0, damping_ = 1e-2;
};

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
  StopCriteria stop;
  stop.max_iterations = options.iterations_per_round;
  for (int round = 0; round < options.rounds; ++round) {
    const PinPlacementProgram program(body, densities, targets, result.pins, result.positions, options.weights,
                                      options.held);
    const double before = program.objective(program.initial_point());
    const Solution solution = PlacementSteps(program).minimize(stop, observer);
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
