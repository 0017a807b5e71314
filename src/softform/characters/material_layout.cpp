#include "softform/characters/material_layout.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "softform/core/interrupt.hpp"

namespace softform {
namespace {

/// Elements that change sides together.
using Flip = std::vector<int>;

template <int dim>
class LayoutRun {
 public:
  using State = typename MaterialDesign<dim>::State;

  LayoutRun(MaterialDesign<dim>& design, const State& first, const MaterialLayoutOptions& options,
            const LayoutObserver& observer)
      : design_(design), options_(options), observer_(observer), weights_(options.weights)
  {
    layout_.state = first;
    layout_.first_distance = std::sqrt(first.distance);
  }

  MaterialLayout<dim> run();

 private:
  State& state() { return layout_.state; }
  double objective(const State& state) const { return design_.objective(state, weights_); }
  bool is_grey(double rho) const { return rho * (1 - rho) > options_.grey; }
  int grey_count() const;
  bool show(const char* phase, int stage, int step);

  void continuation();
  bool stage(int number);
  bool step();
  Vec bounded_step();
  Vec conjugate_gradients(const Vec& rhs, const FixedDofs& free);
  Vec hessian_product(const Vec& v) const;
  std::optional<State> approach(const State& from, const Vec& rho, int halvings) const;
  void follow_pins();
  void round_decided();
  void decide_grey();
  Vec flip_changes() const;
  std::vector<Flip> steepest_flips() const;
  std::vector<Flip> with_partners(const std::vector<Flip>& singles) const;
  std::vector<Flip> promising(const std::vector<Flip>& flips) const;
  bool make_one_of(const std::vector<Flip>& flips);
  bool flip_some();
  void flip();
  void finish();

  MaterialDesign<dim>& design_;
  const MaterialLayoutOptions& options_;
  const LayoutObserver& observer_;
  MaterialWeights weights_;
  MaterialLayout<dim> layout_;
  bool is_stopped_ = false;
  double damping_ = 1;  // on every density, dimensionless as f
  Vec g_;
  SparseMatrix regularisers_;
  SparseFactorization preconditioner_;
};

template <int dim>
int LayoutRun<dim>::grey_count() const
{
  const Vec& rho = layout_.state.rho;
  return static_cast<int>(std::count_if(rho.begin(), rho.end(), [this](double r) { return is_grey(r); }));
}

// Returns false when the run has to stop.
template <int dim>
bool LayoutRun<dim>::show(const char* phase, int stage, int step)
{
  layout_.trace.push_back(
      {phase, stage, step, objective(state()), std::sqrt(state().distance), grey_count(), design_.refused_moves()});
  is_stopped_ = is_stopped_ || interrupted() || (observer_ && !observer_(layout_.trace.back()));
  return !is_stopped_;
}

// The Hessian's model without damping.
template <int dim>
Vec LayoutRun<dim>::hessian_product(const Vec& v) const
{
  Vec Hv;
  design_.distance_product(v, Hv);
  return Hv + regularisers_ * v;
}

// (H + damping) d = rhs on the free densities; preconditioned by all of it but the distances, which have low rank.
template <int dim>
Vec LayoutRun<dim>::conjugate_gradients(const Vec& rhs, const FixedDofs& free)
{
  Vec d = Vec::Zero(rhs.size()), r = rhs;
  free.project(r);
  Vec z = preconditioner_.solve(r), p = z;
  double rz = r.dot(z);
  const double target = options_.cg_tolerance * options_.cg_tolerance * rz;
  for (int k = 0; k < options_.cg_iterations && rz > target; ++k) {
    Vec Hp = hessian_product(p) + damping_ * p;
    free.project(Hp);
    const double step = rz / p.dot(Hp);
    d += step * p;
    r -= step * Hp;
    z = preconditioner_.solve(r);
    const double next = r.dot(z);
    p = z + next / rz * p;
    rz = next;
  }
  return d;
}

// Minimises the model within the bounds: densities that a step carries out of them stay there while the others are
// solved for again.
template <int dim>
Vec LayoutRun<dim>::bounded_step()
{
  const Vec& rho = layout_.state.rho;
  FixedDofs free{Vec::Ones(rho.size())};
  for (Eigen::Index e = 0; e < rho.size(); ++e)
    if ((rho[e] <= 0 && g_[e] > 0) || (rho[e] >= 1 && g_[e] < 0)) free.free[e] = 0;
  Vec d = Vec::Zero(rho.size());
  for (int round = 0; round < 2; ++round) {
    SparseMatrix M = regularisers_;
    shift_diagonal(M, damping_);
    free.project(M, 1);
    preconditioner_.cholesky(M);
    const Vec slope = g_ + hessian_product(d) + damping_ * d;
    d += conjugate_gradients(-slope, free);
    const Vec bounded = (rho + d).cwiseMax(0).cwiseMin(1) - rho;
    const bool is_inside = (bounded - d).isZero(1e-12);
    for (Eigen::Index e = 0; e < rho.size(); ++e)
      if (bounded[e] != d[e]) free.free[e] = 0;
    d = bounded;
    if (is_inside) break;
  }
  return d;
}

// One accepted step; false when no damping gives one.
template <int dim>
bool LayoutRun<dim>::step()
{
  if (!design_.linearize(state(), weights_)) return false;
  const double f = objective(state());
  const double unit = regularisers_.diagonal().mean();
  for (; damping_ <= options_.largest_damping * unit; damping_ *= options_.damping_growth) {
    design_.damp_pins(options_.pin_damping * damping_ / (options_.damping * unit));
    design_.gradient(g_);
    const Vec d = bounded_step();
    const double predicted = design_.pin_decrease() - (g_.dot(d) + 0.5 * d.dot(hessian_product(d)));
    if (!(predicted > 0)) continue;  // the bounds have cut the step too far
    if (interrupted()) return false;
    const auto next = design_.move(state(), state().rho + d, design_.predict(d));
    if (!next || !(objective(*next) < f)) continue;
    const double ratio = (f - objective(*next)) / predicted;
    if (ratio > 0.5) damping_ /= options_.damping_growth;
    if (ratio < 0.1) damping_ *= 2;
    state() = *next;
    return true;
  }
  return false;
}

// Returns false when the run has to stop.
template <int dim>
bool LayoutRun<dim>::stage(int number)
{
  regularisers_ = design_.regulariser_hessian(weights_);
  damping_ = options_.damping * regularisers_.diagonal().mean();
  for (int k = 0; k < options_.steps_per_stage; ++k) {
    const double before = objective(state());
    const bool has_moved = step();
    if (!show("continuation", number, k)) return false;
    if (!has_moved || before - objective(state()) < options_.stage_decrease * before) break;
  }
  return true;
}

template <int dim>
void LayoutRun<dim>::continuation()
{
  const auto enough = static_cast<int>(options_.grey_fraction * double(state().rho.size()));
  for (int k = 0; k < options_.max_stages; ++k) {
    if (!stage(k)) return;
    if (k == 0) layout_.first_distance = std::sqrt(state().distance);
    if (grey_count() <= enough) break;
    weights_.crisp *= options_.crispness_growth;
  }
}

// The state at these densities, on the same branch: in halves where a whole move is refused.
template <int dim>
std::optional<typename LayoutRun<dim>::State> LayoutRun<dim>::approach(const State& from, const Vec& rho,
                                                                       int halvings) const
{
  auto next = design_.move(from, rho);
  if (next || halvings == 0 || interrupted()) return next;
  const auto half = approach(from, (from.rho + rho) / 2, halvings - 1);
  return half ? approach(*half, rho, halvings - 1) : std::nullopt;
}

// Brings free pins to where they are best for the densities as they are.
template <int dim>
void LayoutRun<dim>::follow_pins()
{
  double damping = options_.pin_damping;
  for (int k = 0; design_.has_free_pins() && k < options_.pin_steps && !interrupted(); ++k) {
    const double f = objective(state());
    if (!design_.linearize(state(), weights_)) return;
    for (; damping < options_.largest_damping; damping *= options_.damping_growth) {
      design_.damp_pins(damping);
      const auto next = design_.move(state(), state().rho, design_.predict(Vec::Zero(state().rho.size())));
      if (!next || !(objective(*next) < f)) continue;
      state() = *next;
      damping /= options_.damping_growth;
      break;
    }
    if (f - objective(state()) < options_.stage_decrease * f) return;
  }
}

// Rounds what is nearly decided.
template <int dim>
void LayoutRun<dim>::round_decided()
{
  weights_.crisp = 0;
  Vec rho = state().rho;
  for (double& r : rho)
    if (!is_grey(r)) r = std::round(r);
  if (auto next = approach(state(), rho, options_.largest_halvings)) state() = std::move(*next);
  follow_pins();
}

// Every grey element to the better of its two choices, the greyest last; as it is where both are refused.
template <int dim>
void LayoutRun<dim>::decide_grey()
{
  const Vec rho = state().rho;
  std::vector<int> grey;
  for (int e = 0; e < rho.size(); ++e)
    if (is_grey(rho[e])) grey.push_back(e);
  std::sort(grey.begin(), grey.end(), [&](int a, int b) { return std::abs(rho[a] - 0.5) > std::abs(rho[b] - 0.5); });
  for (const int e : grey) {
    std::optional<State> best;
    for (const double choice : {0.0, 1.0}) {
      Vec decided = state().rho;
      decided[e] = choice;
      auto next = approach(state(), decided, options_.largest_halvings);
      if (next && (!best || objective(*next) < objective(*best))) best = std::move(next);
    }
    if (best) state() = std::move(*best);
    follow_pins();
    if (interrupted()) return;
  }
}

// What the densities do in the model where an element changes sides. On the geometric path the gradient of an element
// is its own stiffness' part in f times log c, whether it is soft or stiff: a flip takes that part away about twice
// over, however large the contrast.
template <int dim>
Vec LayoutRun<dim>::flip_changes() const
{
  const double change = 2 / std::max(1.0, std::log(design_.body().mixture().contrast()));
  return change * (1 - 2 * layout_.state.rho.array()).matrix();
}

// The single elements whose flips have the steepest slopes.
template <int dim>
std::vector<Flip> LayoutRun<dim>::steepest_flips() const
{
  const Vec slopes = g_.cwiseProduct(flip_changes());
  std::vector<int> order(static_cast<std::size_t>(slopes.size()));
  std::iota(order.begin(), order.end(), 0);
  const auto count = std::min<std::ptrdiff_t>(options_.flip_candidates, std::ssize(order));
  std::partial_sort(order.begin(), order.begin() + count, order.end(),
                    [&](int a, int b) { return slopes[a] < slopes[b]; });
  std::vector<Flip> flips;
  for (std::ptrdiff_t k = 0; k < count; ++k) flips.push_back({order[std::size_t(k)]});
  return flips;
}

// Every one of the elements with the one whose flip goes best with its own.
template <int dim>
std::vector<Flip> LayoutRun<dim>::with_partners(const std::vector<Flip>& singles) const
{
  const Vec changes = flip_changes();
  std::set<Flip> pairs;
  for (const Flip& single : singles) {
    const int e = single.front();
    Vec slopes = (g_ + hessian_product(changes[e] * Vec::Unit(changes.size(), e))).cwiseProduct(changes);
    slopes[e] = std::numeric_limits<double>::infinity();
    int partner = 0;
    slopes.minCoeff(&partner);
    pairs.insert({std::min(e, partner), std::max(e, partner)});
  }
  return {pairs.begin(), pairs.end()};
}

// The flips that lower the Gauss-Newton model, the most promising ones first.
template <int dim>
std::vector<Flip> LayoutRun<dim>::promising(const std::vector<Flip>& flips) const
{
  const Vec changes = flip_changes();
  std::vector<std::pair<double, Flip>> ranked;
  for (const Flip& flip : flips) {
    Vec d = Vec::Zero(changes.size());
    for (const int e : flip) d[e] = changes[e];
    const double promise = g_.dot(d) + 0.5 * d.dot(hessian_product(d));
    if (promise < 0) ranked.emplace_back(promise, flip);
  }
  std::sort(ranked.begin(), ranked.end());
  std::vector<Flip> best;
  for (auto& [promise, flip] : ranked) best.push_back(std::move(flip));
  return best;
}

// Makes the first flip that helps, while free pins stay or as they are predicted to follow; returns false when none
// does.
template <int dim>
bool LayoutRun<dim>::make_one_of(const std::vector<Flip>& flips)
{
  const Vec changes = flip_changes();
  const auto is_better = [&](const auto& next) { return next && objective(*next) < objective(state()); };
  for (const Flip& flip : flips) {
    if (interrupted()) return false;
    Vec flipped = state().rho, d = Vec::Zero(changes.size());
    for (const int e : flip) {
      flipped[e] = 1 - flipped[e];
      d[e] = changes[e];
    }
    auto next = design_.move(state(), flipped);
    if (design_.has_free_pins() && !is_better(next)) {
      auto step = design_.predict(d);
      step.x.clear();  // a flip is too far to predict where the body goes
      next = design_.move(state(), flipped, step);
    }
    if (!is_better(next)) continue;
    state() = *next;
    follow_pins();
    return true;
  }
  return false;
}

// Elements that do not help alone may in pairs: what one does too much the other takes back.
template <int dim>
bool LayoutRun<dim>::flip_some()
{
  if (!design_.linearize(state(), weights_)) return false;
  design_.gradient(g_);
  const std::vector<Flip> singles = steepest_flips();
  const bool has_flipped = make_one_of(promising(singles)) || make_one_of(promising(with_partners(singles)));
  if (has_flipped) show("flips", 0, ++layout_.flips);
  return has_flipped;
}

// Flips while they help: first for the mean alone, because the largest distance, in one place, speaks against most of
// them.
template <int dim>
void LayoutRun<dim>::flip()
{
  for (const double part : {0.0, 0.25, 1.0}) {
    if (part > 0 && options_.largest_weight == 0) return;
    weights_.largest = part * options_.largest_weight;
    while (!is_stopped_ && layout_.flips < options_.largest_flips && flip_some()) {
    }
  }
}

template <int dim>
void LayoutRun<dim>::finish()
{
  const Vec& rho = state().rho;
  const auto undecided = (rho.array() * (1 - rho.array()) > 1e-3).count();
  layout_.report.termination = is_stopped_ || interrupted() ? Termination::Interrupted
                               : undecided == 0             ? Termination::Converged
                                                            : Termination::Stalled;
  layout_.refused_moves = design_.refused_moves();
  layout_.report.message =
      fmt::format("{} undecided elements, {} layouts without equilibrium refused", undecided, design_.refused_moves());
}

template <int dim>
MaterialLayout<dim> LayoutRun<dim>::run()
{
  continuation();
  layout_.continued_distance = std::sqrt(state().distance);
  is_stopped_ = is_stopped_ || interrupted();
  if (!is_stopped_) {
    round_decided();
    decide_grey();
    layout_.decided_distance = std::sqrt(state().distance);
    show("decision", 0, 0);
  }
  flip();
  if (!is_stopped_) decide_grey();  // what was refused among other elements may be had among these
  finish();
  return std::move(layout_);
}

}  // namespace

std::string describe(const LayoutProgress& progress)
{
  return fmt::format("{} {}: {:.3f} mm, {} grey", progress.phase, progress.stage, 1e3 * progress.distance,
                     progress.grey_elements);
}

template <int dim>
MaterialLayout<dim> optimize_layout(MaterialDesign<dim>& design, const typename MaterialDesign<dim>::State& first,
                                    const MaterialLayoutOptions& options, const LayoutObserver& observer)
{
  return LayoutRun<dim>(design, first, options, observer).run();
}

template MaterialLayout<2> optimize_layout<2>(MaterialDesign<2>&, const MaterialDesign<2>::State&,
                                              const MaterialLayoutOptions&, const LayoutObserver&);
template MaterialLayout<3> optimize_layout<3>(MaterialDesign<3>&, const MaterialDesign<3>::State&,
                                              const MaterialLayoutOptions&, const LayoutObserver&);

}  // namespace softform
