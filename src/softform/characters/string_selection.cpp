#include "softform/characters/string_selection.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "softform/characters/tension_model.hpp"
#include "softform/core/error.hpp"
#include "softform/core/interrupt.hpp"
#include "softform/linalg/nonnegative_quadratic.hpp"

namespace softform {
namespace {

// (5.9) on the tensions of the candidates, by weights of its quadratic majoriser: first while the smoothing falls, then
// while k_sparse grows. Candidates that have lost their tension are dropped on the way.
std::vector<int> sparse_candidates(const TensionModel& model, int candidates, int count,
                                   const StringSelectionOptions& options)
{
  std::vector<int> left(static_cast<std::size_t>(candidates));
  std::iota(left.begin(), left.end(), 0);
  Vec norms = Vec::Constant(candidates, options.first_smoothing);
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
    std::vector<int> fewer = left;
    std::erase_if(fewer, [&](int j) { return norms[j] <= least; });
    if (static_cast<int>(fewer.size()) < count) break;
    left = std::move(fewer);
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

// Exchanges one string against the candidate that brings most, further than `apart` from the others. Returns whether
// that helps.
bool exchange(const TensionModel& model, const StringCandidates& all, double apart, std::vector<int>& chosen)
{
  const double before = model.least_error(chosen);
  double least = (1 - 1e-6) * before;
  std::vector<int> best;
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    std::vector<int> trial = chosen;
    for (int j = 0; j < all.count(); ++j) {
      const bool is_near = std::any_of(chosen.begin(), chosen.end(), [&](int other) {
        return other != chosen[k] && (all.site_of(other).place - all.site_of(j).place).norm() < apart;
      });
      if (is_near) continue;
      trial[k] = j;
      const double error = model.least_error(trial);
      if (error >= least) continue;
      least = error;
      best = trial;
    }
  }
  if (best.empty()) return false;
  chosen = std::move(best);
  return true;
}

}  // namespace

StringSelection select_strings(const PosedBody& posed, const Ring& ring, int count,
                               const StringSelectionOptions& options, const StageObserver& observer)
{
  const auto report = [&](const std::string& text) { return !interrupted() && (!observer || observer(text)); };
  const StringCandidates all = string_candidates(posed, ring, options.candidates);
  if (count < 1 || all.count() < count)
    throw InputError(
        fmt::format("{} strings cannot be had: {} can be drawn from the boundary to the ring without "
                    "crossing the body",
                    count, all.count()));
  report(fmt::format("what {} strings would do", all.count()));
  const TensionModel model(posed, all, options.tension_weight);
  std::vector<int> chosen = sparse_candidates(model, all.count(), count, options);
  StringSelection result;
  result.candidates = all.count();
  result.sparse_candidates = static_cast<int>(chosen.size());
  chosen = eliminated(model, std::move(chosen), static_cast<std::size_t>(count));
  const double apart = BoundaryField(posed.body).radius();
  for (int k = 0; k < options.most_exchanges; ++k) {
    if (!report(fmt::format("exchange {}: 1/2 sum of squares {:.4g} mm^2 expected", k, model.least_error(chosen))))
      break;
    if (!exchange(model, all, apart, chosen)) break;
  }
  result.expected_error = model.least_error(chosen);
  result.strings = all.layout(chosen, model.best_tensions(chosen));
  result.poses = settled(posed, result.strings, posed.targets, options.easing_steps);
  return result;
}

}  // namespace softform
