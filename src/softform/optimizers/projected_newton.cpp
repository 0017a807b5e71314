#include "softform/optimizers/projected_newton.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "softform/core/interrupt.hpp"

namespace softform {
namespace {

Vec product(const SparseMatrix& A, ConstVec s) { return A.selfadjointView<Eigen::Lower>() * s; }

}  // namespace

ProjectedNewton::ProjectedNewton(const NonlinearProgram& program, const ProjectedNewtonOptions& options,
                                 const StopCriteria& stop, const IterationObserver& observer)
    : program_(program, solution_.report.evaluations),
      options_(options),
      stop_(stop),
      monitor_(stop, observer, solution_.report, stop.tolerance),
      function_(program_, options.hessian),
      lower_(program.lower_bounds()),
      upper_(program.upper_bounds()),
      has_bounds_((lower_.array() > -HUGE_VAL).any() || (upper_.array() < HUGE_VAL).any()),
      damping_(options.damping)
{}

// z - P(z - v), without the cancellation that makes every v vanish where z is large.
Vec ProjectedNewton::projected(const Vec& z, const Vec& v) const { return v.cwiseMax(z - upper_).cwiseMin(z - lower_); }

double ProjectedNewton::stationarity(const AugmentedPoint& point) const
{
  return projected(point.z, point.gradient / std::max(1.0, point.slope)).cwiseAbs().maxCoeff();
}

// phi and its gradient at the current point. Returns false, with the report closed, when they are not finite.
bool ProjectedNewton::refresh()
{
  point_ = function_.evaluate(point_.z);
  if (function_.differentiate(point_) && std::isfinite(point_.value)) return true;
  monitor_.finish(Termination::NotFinite, "the objective, a constraint or a derivative is not finite");
  return false;
}

bool ProjectedNewton::record(double step_norm)
{
  return !monitor_.record({k_++, point_.objective, stationarity(), point_.infeasibility(), step_norm, 0}, &point_.z);
}

bool ProjectedNewton::start()
{
  point_.z = project(program_.initial_point());
  return refresh() && record(0);
}

ProjectedNewton::Outcome ProjectedNewton::minimize(double tolerance)
{
  if (!refresh()) return Outcome::Ended;
  for (int slow = 0; stationarity() > tolerance && slow < stop_.patience;) {
    const Vec z = point_.z;
    const double before = point_.value;
    if (!function_.linearize(point_)) {
      finish(Termination::NotFinite, "a second derivative is not finite");
      return Outcome::Ended;
    }
    if (!advance()) {
      if (!interrupted()) return Outcome::Stalled;
      finish(Termination::Interrupted, "interrupted");
      return Outcome::Ended;
    }
    if (!record((point_.z - z).norm())) return Outcome::Ended;
    slow = before - point_.value < stop_.relative_decrease * std::abs(before) ? slow + 1 : 0;
  }
  return Outcome::Done;
}

// Raises the damping until a step is accepted. Returns false when none is.
bool ProjectedNewton::advance()
{
  constexpr double round_off = 1e-12;
  constexpr int most_lost = 8;
  const double first_damping = damping_;
  int lost = 0;
  for (; damping_ <= options_.largest_damping && !interrupted(); damping_ *= options_.damping_increase) {
    const SparseMatrix& A = function_.model(damping_);
    const std::optional<Vec> z = model_minimizer(A);
    if (!z) continue;
    const double predicted = -model_value(A, *z - point_.z);
    AugmentedPoint trial = function_.evaluate(*z);
    // A decrease that is lost in round-off cannot be judged; one of the gradient can.
    const bool is_lost = predicted < round_off * (std::abs(point_.objective) + std::abs(point_.value));
    if (is_lost && ++lost > most_lost) break;
    if (is_lost ? !lowers_gradient(trial) : !lowers_value(trial, predicted)) continue;
    if (damping_ == first_damping && point_.value - trial.value > 0.75 * predicted)
      damping_ = std::max(options_.smallest_damping, damping_ * options_.damping_decrease);
    point_ = std::move(trial);
    return true;
  }
  damping_ = options_.damping;
  return false;
}

bool ProjectedNewton::lowers_value(AugmentedPoint& trial, double predicted)
{
  constexpr double fair_share = 1e-4;
  return point_.value - trial.value >= fair_share * predicted && function_.differentiate(trial);
}

bool ProjectedNewton::lowers_gradient(AugmentedPoint& trial)
{
  constexpr double noticeable = 0.9;
  return std::isfinite(trial.value) && function_.differentiate(trial) &&
         stationarity(trial) < noticeable * stationarity(point_);
}

double ProjectedNewton::model_value(const SparseMatrix& A, ConstVec s) const
{
  return point_.gradient.dot(s) + 0.5 * s.dot(product(A, s));
}

// The minimiser of the model in the box, or nothing when the model is not convex on a face.
std::optional<Vec> ProjectedNewton::model_minimizer(const SparseMatrix& A)
{
  if (!has_bounds_) return face_minimizer(A, point_.z);
  Vec z = cauchy_point(A);
  double value = model_value(A, z - point_.z);
  for (int faces = 0; faces < options_.largest_face_count; ++faces) {
    const std::optional<Vec> minimizer = face_minimizer(A, z);
    if (!minimizer) return std::nullopt;
    // Project what leaves the box, as long as that lowers the model; backtrack towards z otherwise.
    Vec next = project(*minimizer);
    const bool is_inside = next == *minimizer;
    double t = 1;
    while (model_value(A, next - point_.z) > value && t > 1e-10) next = project(z + (t *= 0.5) * (*minimizer - z));
    const double next_value = model_value(A, next - point_.z);
    if (!(next_value < value)) break;
    z = next;
    value = next_value;
    if (is_inside) break;
  }
  return z;
}

// A point with sufficient decrease of the model along the projected gradient path P(z - t g): from the minimiser along
// the unprojected direction backwards where the bends of the path spoil the decrease, or else forwards while it pays.
Vec ProjectedNewton::cauchy_point(const SparseMatrix& A) const
{
  constexpr double sufficient = 0.1;
  const auto along = [&](double t) { return project(point_.z - t * point_.gradient); };
  const auto is_sufficient = [&](const Vec& z) {
    const Vec s = z - point_.z;
    return model_value(A, s) <= sufficient * point_.gradient.dot(s);
  };
  Vec p = point_.gradient;  // without what points out of the box
  for (Eigen::Index i = 0; i < p.size(); ++i)
    if ((p[i] > 0 && point_.z[i] <= lower_[i]) || (p[i] < 0 && point_.z[i] >= upper_[i])) p[i] = 0;
  const double curvature = p.dot(product(A, p));
  double t = curvature > 0 ? p.squaredNorm() / curvature : 1;
  Vec z = along(t);
  if (!is_sufficient(z)) {
    for (int i = 0; i < 60 && !is_sufficient(z); ++i) z = along(t *= 0.25);
    return z;
  }
  for (int i = 0; i < 20; ++i) {
    const Vec further = along(t *= 2);
    if (further == z || model_value(A, further - point_.z) >= model_value(A, z - point_.z)) break;
    z = further;
  }
  return z;
}

// The minimiser of the model over the variables that are off their bounds at z. The others keep their rows as those of
// the identity, so that the pattern, and its analysis, stays.
std::optional<Vec> ProjectedNewton::face_minimizer(const SparseMatrix& A, ConstVec z)
{
  Vec residual = -point_.gradient - product(A, z - point_.z);
  ++solution_.report.evaluations.linear_solve;
  if (!has_bounds_) {
    if (!factorization_.cholesky(A)) return std::nullopt;
  } else {
    const auto is_fixed = [&](Eigen::Index i) { return z[i] <= lower_[i] || z[i] >= upper_[i]; };
    face_ = A;
    for (int j = 0; j < face_.outerSize(); ++j) {
      for (SparseMatrix::InnerIterator entry(face_, j); entry; ++entry)
        if (is_fixed(j) || is_fixed(entry.row())) entry.valueRef() = entry.row() == j;
      if (is_fixed(j)) residual[j] = 0;
    }
    if (!factorization_.cholesky(face_)) return std::nullopt;
  }
  return z + factorization_.solve(residual);
}

bool ProjectedNewton::finish_feasible(double inner_tolerance)
{
  if (point_.infeasibility() > stop_.tolerance) return false;
  const bool is_stationary = stationarity() <= stop_.tolerance;
  if (!is_stationary && inner_tolerance > stop_.tolerance) return false;
  finish(is_stationary ? Termination::Converged : Termination::Stalled,
         fmt::format("stationarity {:.1e}, infeasibility {:.1e}", stationarity(), point_.infeasibility()));
  return true;
}

void ProjectedNewton::finish_infeasible()
{
  constexpr double at_minimum = 1e-4;
  const double slope = projected(point_.z, function_.infeasibility_gradient(point_)).cwiseAbs().maxCoeff();
  const std::string where = fmt::format("infeasibility {:.1e} at the largest penalty", point_.infeasibility());
  if (slope <= at_minimum * point_.infeasibility())
    finish(Termination::Infeasible, where + ", where the constraints' norm has a minimum");
  else
    finish(Termination::Stalled, where);
}

Solution ProjectedNewton::solution() &&
{
  solution_.z = point_.z;
  solution_.objective = point_.objective;
  if (point_.gradient.size() > 0) {
    solution_.lagrange_multipliers = function_.estimated_multipliers(point_);
    solution_.bound_multipliers = point_.gradient;
    for (Eigen::Index i = 0; i < point_.z.size(); ++i)
      if (point_.z[i] > lower_[i] && point_.z[i] < upper_[i]) solution_.bound_multipliers[i] = 0;
  }
  return std::move(solution_);
}

}  // namespace softform
