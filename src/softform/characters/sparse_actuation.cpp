#include "softform/characters/sparse_actuation.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "softform/core/error.hpp"
#include "softform/mesh/planar_mesh.hpp"
#include "softform/optimizers/augmented_lagrangian.hpp"

namespace softform {
namespace {

// Forces of some newtons and errors of some millimetres: at this penalty neither swallows the other.
constexpr double first_penalty = 100, penalty_increase = 4;

Solution minimize(const SparseActuationProgram& program, int max_iterations)
{
  AugmentedLagrangianOptions method;
  method.penalty = first_penalty;
  method.penalty_increase = penalty_increase;
  method.inner_tolerance = 0.1;
  StopCriteria stop;
  stop.tolerance = 1e-5;
  stop.max_iterations = max_iterations;
  return AugmentedLagrangian(method).minimize(program, stop);
}

PointActuation actuation_from(const SparseActuationProgram& program, const Solution& solution, double least_force)
{
  PointActuation result;
  const Vec norms = program.force_norms(solution.z);
  std::vector<int> kept;
  for (int j = 0; j < norms.size(); ++j)
    if (norms[j] > least_force * norms.maxCoeff()) kept.push_back(j);
  for (const int j : kept) result.vertices.push_back(program.candidates()[static_cast<std::size_t>(j)]);
  for (int pose = 0; pose < program.pose_count(); ++pose) {
    result.positions.push_back(program.positions(solution.z, pose));
    const Vec all = program.forces(solution.z, pose);
    Vec forces(2 * result.count());
    for (int j = 0; j < result.count(); ++j)
      forces.segment<2>(2 * j) = all.segment<2>(2 * kept[static_cast<std::size_t>(j)]);
    result.forces.push_back(std::move(forces));
  }
  result.squared_error = program.squared_error(solution.z);
  result.infeasibility = solution.report.trace.back().infeasibility;
  result.iterations = static_cast<int>(solution.report.trace.size());
  return result;
}

// |(q_j^1, ..., q_j^p)| of the actuators.
Vec force_norms(const PointActuation& actuation)
{
  Vec squares = Vec::Zero(actuation.count());
  for (const Vec& forces : actuation.forces) squares += rows_of(forces).rowwise().squaredNorm();
  return squares.cwiseSqrt();
}

std::vector<int> without(std::vector<int> vertices, Eigen::Index place)
{
  vertices.erase(vertices.begin() + place);
  return vertices;
}

double mean_boundary_edge(const PlanarSolid& body)
{
  const auto faces = boundary_faces<2>(body.elements()).faces;
  const auto points = rows_of(body.rest_positions());
  double sum = 0;
  for (Eigen::Index f = 0; f < faces.rows(); ++f) sum += (points.row(faces(f, 0)) - points.row(faces(f, 1))).norm();
  return sum / static_cast<double>(faces.rows());
}

// The weaker of two actuators that are nearer than `distance` at rest; -1 when there are none.
Eigen::Index weaker_neighbour(const PlanarSolid& body, const PointActuation& actuation, double distance)
{
  const auto points = rows_of(body.rest_positions());
  const Vec norms = force_norms(actuation);
  Eigen::Index weakest = -1;
  for (int a = 0; a < actuation.count(); ++a)
    for (int b = 0; b < actuation.count(); ++b) {
      const double apart = (points.row(actuation.vertices[static_cast<std::size_t>(a)]) -
                            points.row(actuation.vertices[static_cast<std::size_t>(b)]))
                               .norm();
      if (a == b || apart > distance || norms[a] > norms[b]) continue;
      if (weakest < 0 || norms[a] < norms[weakest]) weakest = a;
    }
  return weakest;
}

// What remains when the actuator that is missed least is taken away: every one is tried. The one with the least force
// may well be the one that holds a thin tip. Refits that end out of balance come last.
PointActuation least_missed(const PlanarSolid& body, const std::vector<Vec>& targets, const PointActuation& actuation,
                            const SparseActuationOptions& options, const StageObserver& report)
{
  PointActuation best;
  for (int j = 0; j < actuation.count(); ++j) {
    if (!report(fmt::format("{} actuators: without number {}", actuation.count(), j + 1)) && j > 0) break;
    PointActuation trial = refitted(body, targets, without(actuation.vertices, j), actuation, options);
    const bool is_better =
        trial.is_balanced() == best.is_balanced() ? trial.squared_error < best.squared_error : trial.is_balanced();
    if (best.vertices.empty() || is_better) best = std::move(trial);
  }
  return best;
}

// Boundary vertices that are free to be moved.
std::vector<int> candidates_of(const PlanarSolid& body, const FixedDofs& held)
{
  std::vector<int> vertices = boundary_vertices<2>(body.elements());
  if (held.free.size() > 0)
    vertices.erase(std::remove_if(vertices.begin(), vertices.end(),
                                  [&](int i) { return held.free.segment<2>(2 * i).minCoeff() == 0; }),
                   vertices.end());
  return vertices;
}

void validate(const PlanarSolid& body, const ActuatorRange& range, const FixedDofs& held)
{
  const int candidates = static_cast<int>(candidates_of(body, held).size());
  if (range.fewest < 2 || range.most < range.fewest || range.most > candidates)
    throw InputError(
        fmt::format("{} to {} actuators cannot be had: two are needed to deform anything, the boundary has "
                    "{} free vertices, and the first number must not exceed the second",
                    range.fewest, range.most, candidates));
}

}  // namespace

bool PointActuation::is_balanced() const
{
  double largest = 0;
  for (const Vec& f : forces)
    if (f.size() > 0) largest = std::max(largest, f.lpNorm<Eigen::Infinity>());
  return infeasibility < 1e-3 * largest;
}

PointActuation sparse_actuation(const PlanarSolid& body, const std::vector<Vec>& targets, double weight,
                                const SparseActuationOptions& options)
{
  SparseActuationProgram program(body, targets, candidates_of(body, options.held), {weight, options.alpha, 0},
                                 options.held);
  const double factor =
      std::pow(options.last_smoothing / options.first_smoothing, 1.0 / std::max(1, options.smoothing_steps - 1));
  Solution solution;
  int iterations = 0;
  for (int step = 0; step < options.smoothing_steps; ++step) {
    program.set_smoothing(options.first_smoothing * std::pow(factor, step));
    solution = minimize(program, options.max_iterations);
    iterations += static_cast<int>(solution.report.trace.size());
    program.start_from(solution.z);
  }
  PointActuation result = actuation_from(program, solution, options.least_force);
  result.iterations = iterations;
  return result;
}

PointActuation refitted(const PlanarSolid& body, const std::vector<Vec>& targets, const std::vector<int>& vertices,
                        const PointActuation& start, const SparseActuationOptions& options)
{
  SparseActuationProgram program(body, targets, vertices, {0, options.alpha, 1}, options.held);
  program.start_from(program.point_from(start.positions));
  return actuation_from(program, minimize(program, options.max_refit_iterations), 0);
}

PointActuation actuation_in_range(const PlanarSolid& body, const std::vector<Vec>& targets, const ActuatorRange& range,
                                  const SparseActuationOptions& options, const StageObserver& observer)
{
  validate(body, range, options.held);
  const auto report = [&](const std::string& text) { return !observer || observer(text); };
  constexpr int bisections = 8, nearly = 3;
  double low = 1e-2, high = 1e4;  // [mm^2/N^(2/alpha)]: all of the boundary to hardly any
  PointActuation best;
  for (int i = 0; i < bisections; ++i) {
    const double weight = std::sqrt(low * high);
    PointActuation trial = sparse_actuation(body, targets, weight, options);
    const bool is_enough = trial.count() >= range.fewest;
    const bool is_better = is_enough && (best.vertices.empty() || trial.count() < best.count());
    // A few too many are eliminated faster than they are bisected away.
    const bool is_near = is_enough && trial.count() <= range.most + nearly;
    const bool goes_on = report(fmt::format("k_sparse {:.3g}: {} actuators", weight, trial.count()));
    (is_enough ? low : high) = weight;
    if (is_better) best = std::move(trial);
    if (!goes_on || is_near) break;
  }
  if (best.vertices.empty()) best = sparse_actuation(body, targets, low, options);

  best = refitted(body, targets, best.vertices, best, options);
  const double distance = options.merging_distance * mean_boundary_edge(body);
  while (best.count() > range.fewest) {
    const Eigen::Index place = weaker_neighbour(body, best, distance);
    if (place < 0 && best.count() <= range.most) break;
    best = place < 0 ? least_missed(body, targets, best, options, report)
                     : refitted(body, targets, without(best.vertices, place), best, options);
    if (!report(fmt::format("{} actuators left", best.count()))) break;
  }
  return best;
}

}  // namespace softform
