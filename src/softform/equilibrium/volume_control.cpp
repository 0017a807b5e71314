#include "softform/equilibrium/volume_control.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "softform/equilibrium/newton_iteration.hpp"

namespace softform {
namespace {

// Newton's method for min W(x) s.t. V(x) = V*: the bordered system
//     [ K  -g ] (dx)     ( W' - p g )
//     [ g^t 0 ] (dp) = - ( V - V*   ),   K = W'' - p V'',  g = V',
// solved with two right-hand sides on one factorisation of K.
class VolumeControl {
 public:
  VolumeControl(const PressurizedMembrane& balloon, double volume, const Vec& x0, double pressure0,
                SparseFactorization& factorization, const NewtonOptions& options, const FixedDofs& fixed)
      : balloon_(balloon),
        target_(volume),
        factorization_(factorization),
        options_(options),
        fixed_(fixed),
        shift_(options)
  {
    result_.x = x0;
    result_.pressure = pressure0;
  }

  Equilibrium run();
  void tangent(Vec* dx_dV, double* dp_dV);

 private:
  struct Step {
    Vec dx;
    double dp;
  };
  void evaluate();
  bool factorize_stable();
  bool is_stable_factorization();
  Step newton_step();
  std::optional<double> line_search(const Step& step);

  const PressurizedMembrane& balloon_;
  double target_;
  SparseFactorization& factorization_;
  const NewtonOptions& options_;
  const FixedDofs& fixed_;
  Equilibrium result_;
  double energy_ = 0, excess_ = 0;
  TangentShift shift_;
  bool was_shifted_ = false;    // the last factorisation
  bool is_indefinite_ = false;  // the branch is unstable under pressure control: skip the Cholesky that would fail
  Vec forces_, volume_gradient_, u_, trial_;
  SparseMatrix K_;
};

void VolumeControl::evaluate()
{
  const auto& membrane = balloon_.membrane();
  membrane.gradient(result_.x, balloon_.rest_positions(), forces_);
  balloon_.volume().gradient(result_.x, volume_gradient_);
  fixed_.project(forces_);
  fixed_.project(volume_gradient_);
  energy_ = membrane.value(result_.x, balloon_.rest_positions());
  excess_ = balloon_.volume().value(result_.x) - target_;
  // The least-squares multiplier serves where no pressure is known yet.
  if (result_.pressure == 0) result_.pressure = forces_.dot(volume_gradient_) / volume_gradient_.squaredNorm();
  const double unbalanced = largest_nodal_norm(forces_ - result_.pressure * volume_gradient_);
  result_.residual = unbalanced / balloon_.nodal_pressure_force(result_.x, result_.pressure);
  ++result_.report.evaluations.gradient;
}

// Stable at fixed volume: the bordered matrix has one negative eigenvalue, its border's.
bool VolumeControl::is_stable_factorization()
{
  const int negative = factorization_.negative_eigenvalues();
  if (negative < 0 || negative > 1) return false;
  u_ = factorization_.solve(volume_gradient_);
  ++result_.report.evaluations.linear_solve;
  return (u_.dot(volume_gradient_) > 0 ? 1 : 0) + negative == 1;
}

// Returns false when the tangent is not finite, which no shift mends.
bool VolumeControl::factorize_stable()
{
  was_shifted_ = shift_.value() > 0;
  balloon_.membrane().hessian(result_.x, balloon_.rest_positions(), K_);
  balloon_.volume().add_hessian(result_.x, -result_.pressure, K_);
  ++result_.report.evaluations.hessian;
  const double mean_diagonal = K_.diagonal().cwiseAbs().mean();
  if (!std::isfinite(mean_diagonal)) return false;
  fixed_.project(K_, mean_diagonal);
  shift_diagonal(K_, (options_.rigid_shift + shift_.value()) * mean_diagonal);
  for (;;) {
    if (!is_indefinite_ && factorization_.cholesky(K_)) break;
    factorization_.indefinite(K_);
    is_indefinite_ = factorization_.negative_eigenvalues() > 0;
    if (is_stable_factorization()) return true;
    if (shift_.is_hopeless()) return false;
    shift_diagonal(K_, shift_.raise() * mean_diagonal);
    was_shifted_ = true;
    is_indefinite_ = false;
  }
  u_ = factorization_.solve(volume_gradient_);
  ++result_.report.evaluations.linear_solve;
  return true;
}

VolumeControl::Step VolumeControl::newton_step()
{
  const Vec w = factorization_.solve(forces_ - result_.pressure * volume_gradient_);
  ++result_.report.evaluations.linear_solve;
  const double dp = (volume_gradient_.dot(w) - excess_) / volume_gradient_.dot(u_);
  return {dp * u_ - w, dp};
}

// Backtracking on the augmented Lagrangian W - p (V - V*) + sigma/2 (V - V*)^2 at the new multiplier.
std::optional<double> VolumeControl::line_search(const Step& step)
{
  const double pressure = result_.pressure + step.dp;
  const double curvature = -(forces_ - pressure * volume_gradient_).dot(step.dx);
  double sigma = std::abs(pressure) / target_;
  if (excess_ != 0 && curvature < 0) sigma = std::max(sigma, -2 * curvature / (excess_ * excess_));
  const double merit0 = energy_ - pressure * excess_ + 0.5 * sigma * excess_ * excess_;
  const double slope = -curvature - sigma * excess_ * excess_;
  const bool is_round_off = std::abs(slope) < 1e-10 * std::abs(energy_);
  double alpha = std::min(1.0, options_.step_cap * balloon_.rest_size() / largest_nodal_norm(step.dx));
  for (int backtrack = 0; backtrack < 30; ++backtrack, alpha /= 2) {
    trial_ = result_.x + alpha * step.dx;
    const double excess = balloon_.volume().value(trial_) - target_;
    const double merit = balloon_.membrane().value(trial_, balloon_.rest_positions()) - pressure * excess +
                         0.5 * sigma * excess * excess;
    ++result_.report.evaluations.value;
    if (std::isfinite(merit) && (is_round_off || merit <= merit0 + options_.armijo * alpha * slope)) {
      result_.x.swap(trial_);
      result_.pressure += alpha * step.dp;
      return alpha;
    }
  }
  return std::nullopt;
}

void VolumeControl::tangent(Vec* dx_dV, double* dp_dV)
{
  // A shift would turn the slope of the pressure around where it is small: behind a limit point.
  if (was_shifted_) factorize_stable();
  const double slope = 1 / volume_gradient_.dot(u_);
  if (dx_dV != nullptr) *dx_dV = slope * u_;
  if (dp_dV != nullptr) *dp_dV = slope;
}

Equilibrium VolumeControl::run()
{
  for (int k = 0;; ++k) {
    evaluate();
    const double constraint = std::abs(excess_) / target_;
    result_.report.trace.push_back({k, energy_, result_.residual, constraint, 0, 0});
    const bool is_balanced =
        k > 0 && result_.residual <= options_.tolerance && constraint <= options_.tolerance && shift_.value() == 0;
    if (is_finished(result_, k, energy_, is_balanced, options_)) break;
    if (!factorize_stable()) {
      finish(result_, Termination::NotFinite, "the tangent is not finite");
      break;
    }
    const auto step = line_search(newton_step());
    if (!step) {
      finish(result_, Termination::Stalled,
             fmt::format("no decrease along the Newton step, residual {:.1e}", result_.residual));
      break;
    }
    if (*step == 1) shift_.relax(result_.residual);
  }
  if (result_.report.converged()) result_.negative_eigenvalues = 0;
  return result_;
}

double cube_root_of_ratio(const PressurizedMembrane& balloon, double volume)
{
  return std::cbrt(volume / balloon.rest_volume());
}

// What stays in place when the rest shape grows: the middle of the held vertices, if any, else the centroid.
Eigen::RowVector3d centre_of_growth(const Positions& rest, const FixedDofs& fixed)
{
  if (fixed.free.size() == 0) return rest.colwise().mean();
  const Vec is_held = 1 - unflatten(fixed.free).rowwise().maxCoeff().array();
  if (is_held.sum() == 0) return rest.colwise().mean();
  return is_held.transpose() * rest / is_held.sum();
}

// The rest shape grown by a few percent: without tension a membrane resists no normal motion.
Vec grown_rest(const PressurizedMembrane& balloon, double growth, const FixedDofs& fixed)
{
  const Positions rest = unflatten(balloon.rest_positions());
  const Positions outwards = growth * (rest.rowwise() - centre_of_growth(rest, fixed));
  Vec displacement = flatten(outwards);
  fixed.project(displacement);
  return balloon.rest_positions() + displacement;
}

// Follows the equilibrium path in the cube root of the volume ratio, s.
class InflationPath {
 public:
  InflationPath(const PressurizedMembrane& balloon, SparseFactorization& factorization, const InflationOptions& options,
                const FixedDofs& fixed, const InflationObserver& observer)
      : balloon_(balloon),
        factorization_(factorization),
        options_(options),
        fixed_(fixed),
        observer_(observer),
        step_(options.first_step)
  {
    path_newton_ = options.newton;
    path_newton_.tolerance = options.path_tolerance;
    path_newton_.max_iterations = options.most_iterations;
    state_.x = balloon.rest_positions();
  }

  // Advances one step, at most to s_end. A limit point of the pressure below `wanted_pressure` is stepped over only by
  // a short step. Returns false when the path ended: see state().report.
  bool advance(double s_end, double wanted_pressure = 0);
  double s() const { return s_; }
  Equilibrium& state() { return state_; }
  int iterations() const { return iterations_; }
  double volume_at(double s) const { return balloon_.rest_volume() * s * s * s; }

 private:
  Equilibrium predict(double s) const;

  const PressurizedMembrane& balloon_;
  SparseFactorization& factorization_;
  const InflationOptions& options_;
  const FixedDofs& fixed_;
  const InflationObserver& observer_;
  NewtonOptions path_newton_;
  Equilibrium state_;
  double s_ = 1;
  double step_;
  int iterations_ = 0;
  Vec dx_dV_;
  double dp_dV_ = 0;
};

Equilibrium InflationPath::predict(double s) const
{
  Equilibrium guess = state_;
  if (dx_dV_.size() == 0) {
    guess.x = grown_rest(balloon_, s - 1, fixed_);
    return guess;
  }
  // Along the path x is nearly linear in s: dx/ds = dx/dV dV/ds.
  const double dV = 3 * balloon_.rest_volume() * s_ * s_ * (s - s_);
  guess.x += dV * dx_dV_;
  guess.pressure += dV * dp_dV_;
  return guess;
}

bool InflationPath::advance(double s_end, double wanted_pressure)
{
  for (;;) {
    const bool is_last = s_ + 1.01 * step_ >= s_end;
    const double s = is_last ? s_end : s_ + step_;
    const Equilibrium guess = predict(s);
    Vec dx_dV;
    double dp_dV = 0;
    Equilibrium next = solve_at_volume(balloon_, volume_at(s), guess.x, guess.pressure, factorization_,
                                       is_last ? options_.newton : path_newton_, fixed_, &dx_dV, &dp_dV);
    const int spent = next.iterations;
    iterations_ += spent;
    const bool skips_limit_point =
        next.pressure < wanted_pressure && dp_dV_ >= 0 && dp_dV < 0 && s - s_ > options_.limit_point_step;
    if (next.report.converged() && !skips_limit_point) {
      dx_dV_ = std::move(dx_dV);
      dp_dV_ = dp_dV;
      step_ = spent <= options_.easy_iterations ? std::min(2 * step_, options_.largest_step) : step_;
      s_ = s;
      state_ = std::move(next);
      state_.iterations = iterations_;
      if (observer_ && !observer_({volume_at(s), state_.pressure, spent}, state_.x)) {
        state_.report.termination = Termination::Interrupted;
        return false;
      }
      return true;
    }
    if (next.report.termination == Termination::Interrupted || step_ < options_.smallest_step) {
      state_.report = next.report;
      state_.iterations = iterations_;
      return false;
    }
    step_ = 0.5 * (s - s_);
  }
}

}  // namespace

Equilibrium solve_at_volume(const PressurizedMembrane& balloon, double volume, const Vec& x0, double pressure0,
                            SparseFactorization& factorization, const NewtonOptions& options, const FixedDofs& fixed,
                            Vec* dx_dV, double* dp_dV)
{
  VolumeControl control(balloon, volume, x0, pressure0, factorization, options, fixed);
  Equilibrium equilibrium = control.run();
  if (equilibrium.report.converged()) control.tangent(dx_dV, dp_dV);
  return equilibrium;
}

Equilibrium inflate_to_volume(const PressurizedMembrane& balloon, double volume, SparseFactorization& factorization,
                              const InflationOptions& options, const FixedDofs& fixed,
                              const InflationObserver& observer)
{
  InflationPath path(balloon, factorization, options, fixed, observer);
  const double s_end = cube_root_of_ratio(balloon, volume);
  while (path.s() < s_end && path.advance(s_end)) {
  }
  return std::move(path.state());
}

Equilibrium inflate_to_pressure(const PressurizedMembrane& balloon, double pressure, SparseFactorization& factorization,
                                const InflationOptions& options, double largest_volume_ratio, const FixedDofs& fixed,
                                const InflationObserver& observer)
{
  InflationPath path(balloon, factorization, options, fixed, observer);
  const double s_end = std::cbrt(largest_volume_ratio);
  while (path.state().pressure < pressure) {
    if (path.s() >= s_end) {
      path.state().report.termination = Termination::Infeasible;
      path.state().report.message =
          fmt::format("the pressure is not reached up to {} times the rest volume; the last was {:.6g} Pa",
                      largest_volume_ratio, path.state().pressure);
      return std::move(path.state());
    }
    if (!path.advance(s_end, pressure)) return std::move(path.state());
  }
  Equilibrium equilibrium = solve_at_pressure(balloon, pressure, path.state().x, factorization, options.newton, fixed);
  equilibrium.iterations += path.iterations();
  return equilibrium;
}

}  // namespace softform
