#include "softform/characters/string_placement.hpp"

#include <algorithm>

#include "softform/optimizers/reduced_gauss_newton.hpp"

namespace softform {

StringPoses settled(const PlanarSolid& body, const Vec& densities, const FixedDofs& held, const StringLayout& strings,
                    const std::vector<Vec>& start_positions)
{
  const BoundaryField field(body);
  SparseFactorization factorization;
  StringPoses poses;
  for (std::size_t i = 0; i < start_positions.size(); ++i) {
    const LoadedSolid<2> potential(body, densities, {}, {}, strings_of_pose(field, strings, i));
    const Equilibrium equilibrium = solve_equilibrium(potential, start_positions[i], factorization, {}, held);
    SparseMatrix K;
    potential.hessian(equilibrium.x, K);
    held.project(K, K.diagonal().cwiseAbs().mean());
    poses.positions.push_back(equilibrium.x);
    poses.negative_eigenvalues += count_negative_eigenvalues(std::move(K), factorization);
    poses.residual = std::max(poses.residual, equilibrium.residual);
    poses.failed_equilibria += equilibrium.report.converged() ? 0 : 1;
  }
  return poses;
}

StringPlacement place_strings(const PlanarSolid& body, const Vec& densities, const FixedDofs& held,
                              const std::vector<Vec>& targets, const StringLayout& start,
                              const std::vector<Vec>& start_positions, const StringPlacementOptions& options)
{
  const BoundaryField field(body);
  StringPlacement result{start, settled(body, densities, held, start, start_positions)};
  ReducedGaussNewtonOptions method;
  method.constraint_weight = getenv("MU") ? atof(getenv("MU")) : 1e9;
  StopCriteria stop;
  stop.max_iterations = options.iterations_per_round;
  for (int round = 0; round < options.rounds; ++round) {
    const StringPlacementProgram program(body, densities, held, targets, result.strings, result.poses.positions,
                                         options.weights);
    const Solution solution = ReducedGaussNewton(method).minimize(program, stop);
    result.iterations += static_cast<int>(solution.report.trace.size());
    result.failed_equilibria += program.failed_equilibria();
    StringLayout moved = program.layout(solution.z);
    project_onto_boundary(field, moved.places, moved.sides);
    std::vector<Vec> positions;
    for (int i = 0; i < static_cast<int>(targets.size()); ++i) positions.push_back(program.positions(solution.z, i));
    StringPoses poses = settled(body, densities, held, moved, positions);
    const double before = program.objective(program.initial_point()), after = solution.objective;
    if (poses.failed_equilibria > 0) break;
    result.strings = std::move(moved);
    result.poses = std::move(poses);
    if (after > (1 - options.least_gain) * before) break;
  }
  return result;
}

}  // namespace softform
