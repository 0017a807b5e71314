#include "softform/characters/string_placement.hpp"

#include <algorithm>
#include <cmath>

#include "softform/core/interrupt.hpp"
#include "softform/optimizers/reduced_gauss_newton.hpp"

namespace softform {

StringPoses settled(const PosedBody& posed, const StringLayout& strings, const std::vector<Vec>& start_positions,
                    int easing_steps)
{
  const auto& [body, densities, held, targets] = posed;
  const BoundaryField field(body);
  SparseFactorization factorization;
  StringPoses poses;
  for (std::size_t i = 0; i < start_positions.size(); ++i) {
    const std::vector<String<2>> drawn = strings_of_pose(field, strings, i);
    const LoadedSolid<2> potential(body, densities, {}, {}, drawn);
    Vec x = start_positions[i], missing;
    potential.gradient(x, missing);
    held.project(missing);
    for (int step = 1; step < easing_steps; ++step) {
      const Vec loads = (1 - double(step) / easing_steps) * missing;
      x = solve_equilibrium(LoadedSolid<2>(body, densities, loads, {}, drawn), x, factorization, {}, held).x;
    }
    const Equilibrium equilibrium = solve_equilibrium(potential, x, factorization, {}, held);
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

StringPlacement place_strings(const PosedBody& posed, const StringLayout& start,
                              const std::vector<Vec>& start_positions, const StringPlacementOptions& options,
                              const IterationObserver& observer)
{
  bool is_stopped = false;
  const auto watched = [&](const Iterate& iterate) {
    is_stopped = is_stopped || interrupted() || (observer && !observer(iterate));
    return !is_stopped;
  };
  const BoundaryField field(posed.body);
  StringPlacement result{start, settled(posed, start, start_positions)};
  StringLayout strings = start;
  StringPoses poses = result.poses;
  ReducedGaussNewtonOptions method;
  // Tensions, unlike positions, leave a slender body soft: its compliance is some 100 mm/N, and the model has to know
  // it.
  method.constraint_weight = 1e9;
  StopCriteria stop;
  stop.max_iterations = options.iterations_per_round;
  double least = HUGE_VAL;
  for (int round = 0; round < options.rounds; ++round) {
    const StringPlacementProgram program(posed, strings, poses.positions, options.weights);
    const double before = program.objective(program.initial_point());
    if (before < least) {
      least = before;
      result.strings = strings;
      result.poses = poses;
    }
    const Solution solution = ReducedGaussNewton(method).minimize(program, stop, watched);
    result.iterations += static_cast<int>(solution.report.trace.size());
    result.failed_equilibria += program.failed_equilibria();
    strings = program.layout(solution.z);
    project_onto_boundary(field, strings.places, strings.sides);
    std::vector<Vec> positions;
    for (std::size_t i = 0; i < posed.pose_count(); ++i)
      positions.push_back(program.positions(solution.z, static_cast<int>(i)));
    poses = settled(posed, strings, positions, options.easing_steps);
    result.failed_equilibria += poses.failed_equilibria;
    const bool has_gained = solution.objective < (1 - options.least_gain) * before;
    if (poses.failed_equilibria > 0 || !has_gained || is_stopped) break;
  }
  const StringPlacementProgram last(posed, strings, poses.positions, options.weights);
  if (poses.failed_equilibria == 0 && last.objective(last.initial_point()) < least) {
    result.strings = std::move(strings);
    result.poses = std::move(poses);
  }
  return result;
}

}  // namespace softform
