#include "softform/characters/string_selection.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "softform/characters/tension_model.hpp"
#include "softform/core/error.hpp"
#include "softform/linalg/nonnegative_quadratic.hpp"

namespace softform {
namespace {

constexpr double mm = 1e-3;  // [m]

// (5.9) on the tensions of the candidates, by weights of its quadratic majoriser: first while the smoothing falls, then
// while k_sparse grows. Candidates that have lost their tension are dropped on the way.
std::vector<int> sparse_candidates(const TensionModel& model, int count, const StringSelectionOptions& options)
{
  std::vector<int> left(static_cast<std::size_t>(count));
  std::iota(left.begin(), left.end(), 0);
  Vec norms = Vec::Constant(count, options.first_smoothing);
  const double factor =
      std::pow(options.last_smoothing / options.first_smoothing, 1.0 / std::max(1, options.smoothing_steps - 1));
  double smoothing = options.first_smoothing, weight = options.sparse_weight;
  constexpr int most_steps = 40;
  for (int step = 1; step <= most_steps; ++step) {
    const Vec weights =
        2 * weight / options.alpha * (norms(left).array().square() + smoothing * smoothing).pow(1 / options.alpha - 1);
    Vec squares = Vec::Zero(weights.size());
    for (const TensionModel::Pose& pose : model.poses()) {
      Eigen::MatrixXd M = pose.M(left, left);
      M.diagonal() += weights;
      squares += nonnegative_minimum(M, pose.q(left)).cwiseAbs2();
    }
    norms(left) = squares.cwiseSqrt();
    const double least = options.least_tension * norms(left).maxCoeff();
    std::erase_if(left, [&](int j) { return norms[j] <= least; });
    if (step >= options.smoothing_steps && static_cast<int>(left.size()) <= options.most_candidates) break;
    (step < options.smoothing_steps ? smoothing : weight) *= step < options.smoothing_steps ? factor : 2;
  }
  return left;
}

std::vector<int> without(std::vector<int> chosen, std::size_t place)
{
  chosen.erase(chosen.begin() + static_cast<std::ptrdiff_t>(place));
  return chosen;
}

// Takes away the string that is missed least until `count` remain.
std::vector<int> eliminated(const TensionModel& model, std::vector<int> chosen, std::size_t count)
{
  while (chosen.size() > count) {
    std::vector<int> best;
    double least = HUGE_VAL;
    for (std::size_t k = 0; k < chosen.size(); ++k) {
      const double error = model.least_error(without(chosen, k));
      if (error >= least) continue;
      least = error;
      best = without(chosen, k);
    }
    chosen = std::move(best);
  }
  return chosen;
}

// A string and the candidate that it may be exchanged against.
struct Exchange {
  double error;  // of the model, after it
  std::size_t string;
  int candidate;
};

// The best exchange of each string, the most promising first. Strings stay further than `apart` from each other.
std::vector<Exchange> best_exchanges(const TensionModel& model, const StringCandidates& all, double apart,
                                     const std::vector<int>& chosen)
{
  std::vector<Exchange> best;
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    Exchange found{HUGE_VAL, k, -1};
    std::vector<int> trial = chosen;
    for (int j = 0; j < all.count(); ++j) {
      const bool is_near = std::any_of(chosen.begin(), chosen.end(), [&](int other) {
        return other != chosen[k] && (all.site_of(other).place - all.site_of(j).place).norm() < apart;
      });
      if (is_near) continue;
      trial[k] = j;
      const double error = model.least_error(trial);
      if (error < found.error) found = {error, k, j};
    }
    if (found.candidate >= 0) best.push_back(found);
  }
  std::sort(best.begin(), best.end(), [](const Exchange& a, const Exchange& b) { return a.error < b.error; });
  return best;
}

// The poses under new strings, from positions where they do not balance: what is missing acts as dead loads that are
// taken away in steps, so that a pose stays on the branch of equilibria that it is near to.
StringPoses eased(const PlanarSolid& body, const Vec& densities, const FixedDofs& held, const StringLayout& strings,
                  const std::vector<Vec>& start_positions, int steps)
{
  const BoundaryField field(body);
  SparseFactorization factorization;
  std::vector<Vec> positions;
  for (std::size_t i = 0; i < start_positions.size(); ++i) {
    const std::vector<String<2>> drawn = strings_of_pose(field, strings, i);
    Vec x = start_positions[i], missing;
    LoadedSolid<2>(body, densities, {}, {}, drawn).gradient(x, missing);
    held.project(missing);
    for (int step = 1; step < steps; ++step) {
      const LoadedSolid<2> potential(body, densities, (1 - double(step) / steps) * missing, {}, drawn);
      x = solve_equilibrium(potential, x, factorization, {}, held).x;
    }
    positions.push_back(x);
  }
  return settled(body, densities, held, strings, positions);
}

double squared_error(const std::vector<Vec>& positions, const std::vector<Vec>& targets)
{
  double sum = 0;
  for (std::size_t i = 0; i < targets.size(); ++i) sum += (positions[i] - targets[i]).squaredNorm() / (2 * mm * mm);
  return sum;
}

}  // namespace

StringSelection select_strings(const PlanarSolid& body, const Vec& densities, const FixedDofs& held,
                               const std::vector<Vec>& targets, const Ring& ring, int count,
                               const StringSelectionOptions& options, const SelectionObserver& observer)
{
  const auto say = [&](const std::string& text) {
    if (observer) observer(text);
  };
  const BoundaryField field(body);
  const StringCandidates all = string_candidates(body, held, targets, ring, options.candidates);
  if (count < 1 || all.count() < count)
    throw InputError(
        fmt::format("{} strings cannot be had: {} can be drawn from the boundary to the ring without "
                    "crossing the body",
                    count, all.count()));
  StringSelection result;
  result.candidates = all.count();
  const StringLayout none{ring, {}, {}, {}, std::vector<Vec>(targets.size())};
  const TensionModel model(body, densities, held, targets, all, none, targets, options.tension_weight);
  std::vector<int> chosen = sparse_candidates(model, all.count(), options);
  result.sparse_candidates = static_cast<int>(chosen.size());
  say(fmt::format("{} of {} candidates are left", chosen.size(), all.count()));
  chosen = eliminated(model, std::move(chosen), static_cast<std::size_t>(count));
  double least = model.least_error(chosen);
  for (int k = 0; k < options.most_exchanges; ++k) {
    const std::vector<Exchange> exchanges = best_exchanges(model, all, field.radius(), chosen);
    if (exchanges.empty() || exchanges.front().error > (1 - 1e-6) * least) break;
    least = exchanges.front().error;
    chosen[exchanges.front().string] = exchanges.front().candidate;
  }
  result.strings = all.layout(chosen, model.best_tensions(chosen));
  result.poses = eased(body, densities, held, result.strings, targets, options.easing_steps);
  say(fmt::format("squared error {:.4g} mm^2, {:.4g} expected, {} equilibria not found",
                  squared_error(result.poses.positions, targets), least, result.poses.failed_equilibria));
  return result;
}

StringPlacement thinned_strings(const PlanarSolid& body, const Vec& densities, const FixedDofs& held,
                                const std::vector<Vec>& targets, StringPlacement placement, int count,
                                const StringPlacementOptions& options, const SelectionObserver& observer)
{
  const BoundaryField field(body);
  const auto place = [&](const StringLayout& strings, const std::vector<Vec>& positions,
                         const StringPlacementOptions& how) {
    StringPlacement placed = place_strings(body, densities, held, targets, strings, positions, how);
    placed.iterations += placement.iterations;
    placed.failed_equilibria += placement.failed_equilibria;
    placement = std::move(placed);
  };
  while (placement.strings.count() > count) {
    StringCandidates all{placement.strings.ring, {}, {}};
    const std::vector<int> current = all.add(field, placement.strings);
    const TensionModel model(body, densities, held, targets, all, placement.strings, placement.poses.positions, 0.1);
    const std::vector<int> left = eliminated(model, current, current.size() - 1);
    int lost = 0;
    while (lost < static_cast<int>(left.size()) && left[static_cast<std::size_t>(lost)] == lost) ++lost;
    // The string fades, so that the poses follow.
    StringPlacementOptions fading = options;
    fading.rounds = 1;
    fading.weights.extra_tension = Vec::Zero(placement.strings.count());
    for (double weight = 1; weight < 1e4; weight *= 10) {
      fading.weights.extra_tension[lost] = weight;
      place(placement.strings, placement.poses.positions, fading);
    }
    StringCandidates faded{placement.strings.ring, {}, {}};
    faded.add(field, placement.strings);
    std::vector<Vec> tensions;
    for (const Vec& all_tensions : placement.strings.tensions) tensions.emplace_back(all_tensions(left));
    const StringLayout fewer = faded.layout(left, tensions);
    const StringPoses poses = eased(body, densities, held, fewer, placement.poses.positions, 10);
    const double before = squared_error(poses.positions, targets);
    place(fewer, poses.positions, options);
    if (observer)
      observer(fmt::format("{} strings: {:.4g} mm^2 ({:.4g} expected, {:.4g} before placing)", left.size(),
                           squared_error(placement.poses.positions, targets), model.least_error(left), before));
  }
  return placement;
}

StringPlacement exchange_strings(const PlanarSolid& body, const Vec& densities, const FixedDofs& held,
                                 const std::vector<Vec>& targets, StringPlacement placement,
                                 const StringExchangeOptions& options, const SelectionObserver& observer)
{
  const BoundaryField field(body);
  const StringCandidates candidates =
      string_candidates(body, held, targets, placement.strings.ring, options.candidates);
  for (int k = 0; k < options.most_exchanges; ++k) {
    StringCandidates all = candidates;
    const std::vector<int> current = all.add(field, placement.strings);
    const TensionModel model(body, densities, held, targets, all, placement.strings, placement.poses.positions,
                             options.tension_weight);
    const double before = squared_error(placement.poses.positions, targets), modelled = model.least_error(current);
    bool is_better = false;
    for (const Exchange& exchange : best_exchanges(model, all, field.radius(), current)) {
      if (exchange.error > (1 - options.least_gain) * modelled) break;
      std::vector<int> chosen = current;
      chosen[exchange.string] = exchange.candidate;
      const StringLayout trial = all.layout(chosen, model.best_tensions(chosen));
      const StringPoses poses = eased(body, densities, held, trial, placement.poses.positions, options.easing_steps);
      StringPlacement placed = place_strings(body, densities, held, targets, trial, poses.positions, options.placement);
      const double after = squared_error(placed.poses.positions, targets);
      if (observer)
        observer(fmt::format("string {}: {:.4g} -> {:.4g} mm^2 ({:.4g} expected, {:.4g} before placing)",
                             exchange.string, before, after, exchange.error, squared_error(poses.positions, targets)));
      placement.iterations += placed.iterations;
      placement.failed_equilibria += placed.failed_equilibria;
      if (!(after < (1 - options.least_gain) * before) || placed.poses.failed_equilibria > 0) continue;
      placed.iterations = placement.iterations;
      placed.failed_equilibria = placement.failed_equilibria;
      placement = std::move(placed);
      is_better = true;
      break;
    }
    if (!is_better) break;
  }
  return placement;
}

}  // namespace softform
