#include "softform/characters/string_selection.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include <fmt/format.h>

#include "softform/core/error.hpp"
#include "softform/linalg/nonnegative_quadratic.hpp"
#include "softform/mesh/planar_mesh.hpp"

namespace softform {
namespace {

constexpr double mm = 1e-3;  // [m]

// A boundary vertex where a string may be tied.
struct Site {
  Point<2> place, side;
  std::vector<BoundaryWeight> weights;
};

struct Candidate {
  std::size_t site;
  double angle;
};

// Every string that may be used.
struct Candidates {
  std::vector<Site> sites;
  std::vector<Candidate> strings;

  int count() const { return static_cast<int>(strings.size()); }
  const Site& site_of(int j) const { return sites[strings[static_cast<std::size_t>(j)].site]; }
  double angle_of(int j) const { return strings[static_cast<std::size_t>(j)].angle; }
};

Candidates all_candidates(const PlanarSolid& body, const BoundaryField& field, const FixedDofs& held, const std::vector<Vec>& targets, const Ring& ring,
                          const StringSelectionOptions& options)
{
  const auto edges = boundary_faces<2>(body.elements()).faces;
  const Vec& X = body.rest_positions();
  Candidates all;
  for (const int vertex : boundary_vertices<2>(body.elements())) {
    if (held.free.size() > 0 && held.free.segment<2>(2 * vertex).minCoeff() == 0) continue;
    Site site{X.segment<2>(2 * vertex), field.normal(X.segment<2>(2 * vertex)), {}};
    site.weights = field.weights(site.place, field.kernels(site.place, site.side, field.radius()));
    const Point<2> from = weighted_mean(site.weights, X);
    const auto crosses = [&](const Vec& x, double angle) {
      return length_inside(edges, x, weighted_mean(site.weights, x), ring.at(angle)) > field.radius() / 4;
    };
    const std::size_t index = all.sites.size();
    for (int k = 0; k < options.ring_points; ++k) {
      const double angle = 2 * std::numbers::pi * k / options.ring_points;
      const Point<2> way = ring.at(angle) - from;
      if (way.normalized().dot(site.side) > options.least_cosine &&
          !crosses(X, angle) && std::none_of(targets.begin(), targets.end(), [&](const Vec& t) { return crosses(t, angle); }))
        all.strings.push_back({index, angle});
    }
    all.sites.push_back(std::move(site));
  }
  return all;
}

StringLayout layout_of(const Candidates& all, const Ring& ring, const std::vector<int>& chosen,
                       const std::vector<Vec>& tensions)
{
  StringLayout layout{ring, {}, {}, {}, tensions};
  for (const int j : chosen) {
    layout.places.push_back(all.site_of(j).place);
    layout.sides.push_back(all.site_of(j).side);
    layout.angles.push_back(all.angle_of(j));
  }
  return layout;
}

// The squared errors [mm^2] of all poses as quadratic functions of the candidates' tensions [N], about given poses.
class TensionModel {
 public:
  TensionModel(const PlanarSolid& body, const Vec& densities, const FixedDofs& held, const std::vector<Vec>& targets,
               const Candidates& all, const StringLayout& strings, const std::vector<Vec>& positions,
               double tension_weight);

  int pose_count() const { return static_cast<int>(poses_.size()); }
  // 1/2 |x - t|^2 = constant + q . tau + 1/2 tau . M tau.
  struct Pose {
    double constant;
    Vec q;
    Eigen::MatrixXd M;
  };
  const Pose& pose(int i) const { return poses_[static_cast<std::size_t>(i)]; }
  Vec best_tensions(const std::vector<int>& chosen, int pose) const;
  std::vector<Vec> best_tensions(const std::vector<int>& chosen) const;
  double least_error(const std::vector<int>& chosen) const;

 private:
  std::vector<Pose> poses_;
};

TensionModel::TensionModel(const PlanarSolid& body, const Vec& densities, const FixedDofs& held,
                           const std::vector<Vec>& targets, const Candidates& all, const StringLayout& strings,
                           const std::vector<Vec>& positions, double tension_weight)
{
  const BoundaryField field(body);
  SparseFactorization factorization;
  for (std::size_t i = 0; i < targets.size(); ++i) {
    const Vec& x = positions[i];
    const LoadedSolid<2> potential(body, densities, {}, {}, strings_of_pose(field, strings, i));
    SparseMatrix K;
    potential.hessian(x, K);
    const double diagonal = K.diagonal().cwiseAbs().mean();
    held.project(K, diagonal);
    if (!factorization.cholesky(K)) {  // a target need not be near a stable equilibrium
      potential.projected_hessian(x, K);
      held.project(K, diagonal);
      shift_diagonal(K, 1e-6 * diagonal);
      factorization.cholesky(K);
    }
    Vec g;
    body.gradient(x, densities, g);
    held.project(g);
    const Vec offset = (x - targets[i] - factorization.solve(g)) / mm;
    // Responses to unit forces at the sites, then the candidates' directions.
    const auto sites = static_cast<Eigen::Index>(all.sites.size());
    Eigen::MatrixXd responses(x.size(), 2 * sites), directions = Eigen::MatrixXd::Zero(2 * sites, all.count());
    for (Eigen::Index s = 0; s < sites; ++s)
      for (int p = 0; p < 2; ++p) {
        Vec load = Vec::Zero(x.size());
        for (const BoundaryWeight& w : all.sites[static_cast<std::size_t>(s)].weights) load[2 * w.vertex + p] = w.value;
        held.project(load);
        responses.col(2 * s + p) = factorization.solve(load) / mm;
      }
    for (int j = 0; j < all.count(); ++j)
      directions.col(j).segment<2>(2 * static_cast<Eigen::Index>(all.strings[static_cast<std::size_t>(j)].site)) =
          (strings.ring.at(all.angle_of(j)) - weighted_mean(all.site_of(j).weights, x)).normalized();
    const Eigen::MatrixXd gram = responses.transpose() * responses;
    poses_.push_back({offset.squaredNorm() / 2, directions.transpose() * (responses.transpose() * offset),
                      directions.transpose() * (gram * directions)});
    poses_.back().M.diagonal().array() += tension_weight;
  }
}

Vec TensionModel::best_tensions(const std::vector<int>& chosen, int pose) const
{
  const Pose& model = poses_[static_cast<std::size_t>(pose)];
  return nonnegative_minimum(model.M(chosen, chosen), model.q(chosen));
}

std::vector<Vec> TensionModel::best_tensions(const std::vector<int>& chosen) const
{
  std::vector<Vec> tensions;
  for (int i = 0; i < pose_count(); ++i) tensions.push_back(best_tensions(chosen, i));
  return tensions;
}

double TensionModel::least_error(const std::vector<int>& chosen) const
{
  double sum = 0;
  for (int i = 0; i < pose_count(); ++i) {
    const Pose& model = pose(i);
    // At the minimum  tau . M tau = -q . tau.
    sum += model.constant + model.q(chosen).dot(best_tensions(chosen, i)) / 2;
  }
  return sum;
}

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
    const Vec weights = 2 * weight / options.alpha *
                        (norms(left).array().square() + smoothing * smoothing).pow(1 / options.alpha - 1);
    Vec squares = Vec::Zero(weights.size());
    for (int i = 0; i < model.pose_count(); ++i) {
      Eigen::MatrixXd M = model.pose(i).M(left, left);
      M.diagonal() += weights;
      squares += nonnegative_minimum(M, model.pose(i).q(left)).cwiseAbs2();
    }
    norms(left) = squares.cwiseSqrt();
    const double least = options.least_tension * norms(left).maxCoeff();
    std::erase_if(left, [&](int j) { return norms[j] <= least; });
    fprintf(stderr,"step %d smoothing %g weight %g left %d\n",step,smoothing,weight,(int)left.size());
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

// One pass: every string is replaced by the candidate that brings most, if any brings something. Strings stay further
// than `apart` from each other. Returns whether one was replaced.
bool exchange(const TensionModel& model, const Candidates& all, double apart, std::vector<int>& chosen)
{
  bool is_better = false;
  double least = model.least_error(chosen);
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    std::vector<int> trial = chosen;
    for (int j = 0; j < all.count(); ++j) {
      const bool is_near = std::any_of(chosen.begin(), chosen.end(), [&](int other) {
        return other != chosen[k] && (all.site_of(other).place - all.site_of(j).place).norm() < apart;
      });
      if (is_near) continue;
      trial[k] = j;
      const double error = model.least_error(trial);
      if (error >= (1 - 1e-6) * least) continue;
      least = error;
      chosen[k] = j;
      is_better = true;
    }
  }
  return is_better;
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
  const Candidates all = all_candidates(body, field, held, targets, ring, options);
  if (count < 1 || all.count() < count)
    throw InputError(
        fmt::format("{} strings cannot be had: {} can be drawn from the boundary to the ring without "
                    "crossing the body",
                    count, all.count()));
  StringSelection result;
  result.candidates = all.count();
  result.strings.ring = ring;
  result.strings.tensions.resize(targets.size());
  result.poses.positions = targets;
  std::vector<int> chosen;
  double least = HUGE_VAL;
  for (int round = 0; round < options.rounds; ++round) {
    const TensionModel model(body, densities, held, targets, all, result.strings, result.poses.positions,
 options.tension_weight);
    if (round == 0) {
      chosen = sparse_candidates(model, all.count(), options);
      result.sparse_candidates = static_cast<int>(chosen.size());
      say(fmt::format("{} of {} candidates are left", chosen.size(), all.count()));
      chosen = eliminated(model, std::move(chosen), static_cast<std::size_t>(count));
    }
    for (int pass = 0; pass < options.exchange_passes && exchange(model, all, field.radius(), chosen); ++pass) {
    }
    StringLayout strings = layout_of(all, ring, chosen, model.best_tensions(chosen));
    StringPoses poses = eased(body, densities, held, strings, result.poses.positions, options.easing_steps);
    const double error = squared_error(poses.positions, targets);
    say(fmt::format("squared error {:.4g} mm^2, {:.4g} expected, {} equilibria not found", error,
                    model.least_error(chosen), poses.failed_equilibria));
    if (!(error < least) || poses.failed_equilibria > 0) {
      ++result.failed_rounds;
      break;
    }
    const bool is_last = error > 0.99 * least;
    least = error;
    result.strings = std::move(strings);
    result.poses = std::move(poses);
    if (is_last) break;
  }
  return result;
}

}  // namespace softform
