#include "softform/characters/material_layout.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "softform/core/interrupt.hpp"

namespace softform {
namespace {

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
  void decide();
  double flip_change() const;
  std::vector<int> flip_candidates() const;
  bool flip_one();
  void finish(bool is_stopped);

  MaterialDesign<dim>& design_;
  const MaterialLayoutOptions& options_;
  const LayoutObserver& observer_;
  MaterialWeights weights_;
  MaterialLayout<dim> layout_;
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
  return !interrupted() && (!observer_ || observer_(layout_.trace.back()));
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

// Rounds what is nearly decided, then every other element to the better of its two choices, the greyest last.
template <int dim>
void LayoutRun<dim>::decide()
{
  weights_.crisp = 0;
  std::vector<int> grey;
  Vec rho = state().rho;
  for (int e = 0; e < rho.size(); ++e) {
    if (is_grey(rho[e]))
      grey.push_back(e);
    else
      rho[e] = std::round(rho[e]);
  }
  if (auto next = approach(state(), rho, options_.largest_halvings)) state() = std::move(*next);
  follow_pins();
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

// How far a flip goes in the model. On the geometric path the gradient of an element is its own stiffness' part in f
// times log c, whether it is soft or stiff: an element that changes sides takes that part away about twice over,
// however large the contrast.
template <int dim>
double LayoutRun<dim>::flip_change() const
{
  return 2 / std::max(1.0, std::log(design_.body().mixture().contrast()));
}

// Elements in the order of what their flip promises, the first few by the Gauss-Newton model.
template <int dim>
std::vector<int> LayoutRun<dim>::flip_candidates() const
{
  const Vec& rho = layout_.state.rho;
  const Vec direction = flip_change() * (1 - 2 * rho.array()).matrix();
  Vec promise = g_.cwiseProduct(direction);
  std::vector<int> order(static_cast<std::size_t>(rho.size()));
  std::iota(order.begin(), order.end(), 0);
  const auto count = std::min<std::ptrdiff_t>(options_.flip_candidates, std::ssize(order));
  const auto by_promise = [&](int a, int b) { return promise[a] < promise[b]; };
  std::partial_sort(order.begin(), order.begin() + count, order.end(), by_promise);
  order.resize(static_cast<std::size_t>(count));
  for (const int e : order) {
    const Vec d = direction[e] * Vec::Unit(rho.size(), e);
    promise[e] += 0.5 * d.dot(hessian_product(d));
  }
  std::sort(order.begin(), order.end(), by_promise);
  order.erase(std::find_if(order.begin(), order.end(), [&](int e) { return promise[e] >= 0; }), order.end());
  return order;
}

// Flips the first element that helps, while free pins stay or as they are predicted to follow; returns false when none
// of the candidates does.
template <int dim>
bool LayoutRun<dim>::flip_one()
{
  if (!design_.linearize(state(), weights_)) return false;
  design_.gradient(g_);
  for (const int e : flip_candidates()) {
    if (interrupted()) return false;
    Vec flipped = state().rho;
    flipped[e] = 1 - flipped[e];
    const auto is_better = [&](const auto& next) { return next && objective(*next) < objective(state()); };
    auto next = design_.move(state(), flipped);
    if (design_.has_free_pins() && !is_better(next)) {
      auto step = design_.predict(flip_change() * (flipped - state().rho));
      step.x.clear();  // a flip is too far to predict where the body goes
      next = design_.move(state(), flipped, step);
    }
    if (!is_better(next)) continue;
    state() = *next;
    follow_pins();
    return show("flips", 0, ++layout_.flips);
  }
  return false;
}

template <int dim>
void LayoutRun<dim>::finish(bool is_stopped)
{
  const Vec& rho = state().rho;
  const auto undecided = (rho.array() * (1 - rho.array()) > 1e-3).count();
  layout_.report.termination = is_stopped       ? Termination::Interrupted
                               : undecided == 0 ? Termination::Converged
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
  bool is_running = !interrupted();
  if (is_running) {
    decide();
    layout_.decided_distance = std::sqrt(state().distance);
    is_running = show("decision", 0, 0);
  }
  weights_.largest = options_.largest_weight;
  while (is_running && layout_.flips < options_.largest_flips) is_running = flip_one();
  finish(interrupted());
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
