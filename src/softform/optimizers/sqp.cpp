#include "softform/optimizers/sqp.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "softform/optimizers/counted_program.hpp"
#include "softform/optimizers/kkt_system.hpp"
#include "softform/optimizers/monitor.hpp"
#include "softform/optimizers/optimality.hpp"

namespace softform {
namespace {

double largest(ConstVec v) { return v.size() > 0 ? v.cwiseAbs().maxCoeff() : 0; }

/// One where there are none, or nothing but zeros.
double largest_entry(const SparseMatrix& A)
{
  const double value = A.nonZeros() > 0 ? A.coeffs().abs().maxCoeff() : 0;
  return value > 0 ? value : 1;
}

/// An upper bound of |J|_2: sqrt(|J|_1 |J|_infinity).
double norm_bound(const SparseMatrix& J)
{
  Vec row_sums = Vec::Zero(J.rows());
  double largest_column = 0;
  for (int j = 0; j < J.outerSize(); ++j) {
    double column = 0;
    for (SparseMatrix::InnerIterator entry(J, j); entry; ++entry) {
      column += std::abs(entry.value());
      row_sums[entry.row()] += std::abs(entry.value());
    }
    largest_column = std::max(largest_column, column);
  }
  return std::sqrt(largest_column * largest(row_sums));
}

class Run {
 public:
  Run(const NonlinearProgram& program, const SqpOptions& options, const StopCriteria& stop,
      const IterationObserver& observer)
      : program_(program, solution_.report.evaluations),
        options_(options),
        tolerance_(stop.tolerance),
        monitor_(stop, observer, solution_.report, stop.tolerance)
  {}

  Solution minimize();

 private:
  void start();
  void linearize();
  bool is_finished(int k);
  bool factorize();
  bool find_step();
  bool accept(double dWd, double tangential, double normal);
  void read_hessian();
  double next_shift() const;
  bool advance();
  bool search_line(double smallest);
  bool try_point(const Vec& z, double alpha);
  Vec corrected_step() const;
  double merit() const { return f_ + mu_ * c_.lpNorm<1>(); }
  double model_reduction() const;
  void explain_failure();
  const char* curvature_at_the_end();

  Solution solution_;
  CountedProgram program_;
  const SqpOptions& options_;
  double tolerance_;
  Monitor monitor_;
  double f_ = 0, mu_ = 0, step_norm_ = 0;
  double shift_ = 0, unit_ = 1;  // multiple of the metric, and the unit of it
  Vec g_, c_, lambda_;
  SparseMatrix H_, D_, J_;
  KktSystem kkt_{options_.constraint_regularization};
  KktSystem::Step step_;
  bool has_step_ = false;
};

void Run::start()
{
  Vec& z = solution_.z = program_.initial_point();
  lambda_ = Vec::Zero(program_.constraint_count());
  c_.resize(0);
  J_.resize(0, program_.variable_count());
  f_ = program_.objective(z);
  if (lambda_.size() > 0) program_.constraints(z, c_);
  linearize();
  if (g_.allFinite() && J_.coeffs().allFinite()) lambda_ = least_squares_multipliers(g_, J_);
  mu_ = std::max(1e-8, options_.first_penalty * largest(lambda_));
}

void Run::linearize()
{
  program_.objective_gradient(solution_.z, g_);
  if (c_.size() > 0) program_.constraint_jacobian(solution_.z, J_);
}

bool Run::is_finished(int k)
{
  const Vec gradient = g_ + J_.transpose() * lambda_;
  const double infeasibility = c_.allFinite() ? largest(c_) : std::nan("");
  const double stationarity = gradient.allFinite() ? largest(gradient) / std::max(1.0, largest(g_)) : std::nan("");
  const bool must_stop = monitor_.record({k, f_, stationarity, infeasibility, step_norm_, 0}, &solution_.z);
  if (!std::isfinite(stationarity)) return monitor_.finish(Termination::NotFinite, "a derivative is not finite");
  if (infeasibility <= tolerance_ && stationarity <= tolerance_)
    return monitor_.finish(Termination::Converged,
                           fmt::format("first-order conditions met, {}", curvature_at_the_end()));
  return must_stop;
}

// By the inertia of the unshifted KKT matrix.
const char* Run::curvature_at_the_end()
{
  shift_ = 0;
  if (!program_.lagrangian_hessian(solution_.z, lambda_, H_)) return "curvature unknown";
  if (!factorize()) return "singular";
  return kkt_.is_convex() ? "a minimum" : "not a minimum: negative curvature along the constraints";
}

bool Run::factorize()
{
  ++solution_.report.evaluations.linear_solve;
  return kkt_.factorize(shift_ > 0 ? SparseMatrix(H_ + shift_ * D_) : H_, J_);
}

// Delta m = -g . d + mu (|c|_1 - |c + J d|_1), the decrease of (3.48).
double Run::model_reduction() const { return -g_.dot(step_.d) + mu_ * (c_.lpNorm<1>() - step_.r.lpNorm<1>()); }

// Byrd, Curtis and Nocedal's termination tests: I, the model reduction condition at the present penalty; II, a penalty
// exists that fulfils it, because the step is convex or normal enough. False asks for more convexity.
bool Run::accept(double dWd, double tangential, double normal)
{
  const double theta = options_.curvature * largest_entry(H_);
  const double required = std::max(0.5 * dWd, theta * tangential);
  const double c = c_.lpNorm<1>(), r = step_.r.lpNorm<1>();
  const double roundoff = 1e-14 * (std::abs(g_.dot(step_.d)) + mu_ * c);
  const bool helps_constraints = r <= options_.linearized_decrease * c;
  if (model_reduction() + roundoff >= required + options_.tau * mu_ * std::max(c, r - c)) return true;

  const bool is_convex = 0.5 * dWd >= theta * tangential;
  const bool is_normal = tangential <= options_.normal_ratio * normal;
  if (!helps_constraints || !(is_convex || is_normal)) return false;
  const double excess = g_.dot(step_.d) + required;
  if (excess > roundoff) mu_ = std::max(mu_, excess / ((1 - options_.tau) * (c - r)));  // (3.51)
  return model_reduction() + roundoff > 0;
}

void Run::read_hessian()
{
  if (!program_.lagrangian_hessian(solution_.z, lambda_, H_)) program_.gauss_newton_hessian(solution_.z, H_);
  program_.step_metric(solution_.z, D_);
  // The metric may be blind to some directions.
  SparseMatrix identity(D_.rows(), D_.cols());
  identity.setIdentity();
  D_ += 1e-6 * largest_entry(D_) * identity;
  unit_ = largest_entry(H_) / largest_entry(D_);
}

double Run::next_shift() const { return std::max(shift_ * options_.shift_increase, options_.first_shift * unit_); }

// Solves (3.44) with a Hessian that is shifted until the step is accepted.
bool Run::find_step()
{
  const double J_norm = norm_bound(J_);
  for (; shift_ <= options_.largest_shift * unit_; shift_ = next_shift()) {
    if (!factorize()) continue;
    step_ = kkt_.solve(g_ + J_.transpose() * lambda_, c_, options_.linear_tolerance);
    if (!step_.d.allFinite() || !step_.delta.allFinite()) continue;
    // Squared norms: a lower bound nu of the normal part's, an upper bound gamma of the tangential one's (3.50).
    const double normal = J_norm > 0 ? (J_ * step_.d).squaredNorm() / (J_norm * J_norm) : 0;
    const double tangential = step_.d.squaredNorm() - normal;
    const double dWd = step_.d.dot(H_ * step_.d) + shift_ * step_.d.dot(D_ * step_.d);
    if (accept(dWd, tangential, normal)) return true;
  }
  return false;
}

bool Run::try_point(const Vec& z, double alpha)
{
  const double f = program_.objective(z);
  Vec c(c_.size());
  if (c.size() > 0) program_.constraints(z, c);
  const double roundoff = 10 * std::numeric_limits<double>::epsilon() * (std::abs(f_) + mu_ * c_.lpNorm<1>());
  // Written so that NaN is refused.
  if (!(f + mu_ * c.lpNorm<1>() <= merit() - options_.armijo * alpha * model_reduction() + roundoff)) return false;
  step_norm_ = (z - solution_.z).norm();
  solution_.z = z;
  f_ = f;
  c_ = c;
  return true;
}

// d + s with s from the same KKT matrix, for the constraints left over at z + d (Nocedal and Wright 2006, 18.3).
Vec Run::corrected_step() const
{
  Vec c;
  program_.constraints(solution_.z + step_.d, c);
  if (!c.allFinite()) return step_.d;
  return step_.d + kkt_.solve(Vec::Zero(step_.d.size()), c, options_.linear_tolerance).d;
}

bool Run::search_line(double smallest)
{
  for (double alpha = 1; alpha >= smallest; alpha /= 2) {
    bool is_accepted = try_point(solution_.z + alpha * step_.d, alpha);
    if (!is_accepted && alpha == 1 && options_.second_order_correction && c_.size() > 0)
      is_accepted = try_point(solution_.z + corrected_step(), alpha);
    if (!is_accepted) continue;
    lambda_ += alpha * step_.delta;
    if (alpha == 1) shift_ *= options_.shift_decrease;
    if (shift_ < options_.smallest_shift * unit_) shift_ = 0;
    return true;
  }
  return false;
}

// A step and a step length that go together.
bool Run::advance()
{
  read_hessian();
  const double first_shift = shift_;
  for (; find_step(); shift_ = next_shift())
    if (search_line(options_.shortest_step)) return true;
  shift_ = first_shift;
  has_step_ = find_step();
  return has_step_ && search_line(options_.smallest_step);
}

void Run::explain_failure()
{
  if (has_step_)
    monitor_.finish(Termination::Stalled, "no step decreases the merit, however small");
  else if (H_.coeffs().allFinite())
    monitor_.finish(Termination::Stalled, "no shift of the Hessian gives a step that decreases the merit's model");
  else
    monitor_.finish(Termination::NotFinite, "the Hessian is not finite");
}

Solution Run::minimize()
{
  start();
  for (int k = 0; !is_finished(k); ++k) {
    const double infeasibility = c_.lpNorm<1>();
    if (!advance()) {
      explain_failure();
      break;
    }
    const bool is_inconsistent = step_.r.lpNorm<1>() > options_.linearized_decrease * infeasibility;
    linearize();
    // Where the linearised constraints contradict each other, delta is what the regularisation made of it.
    if (is_inconsistent && infeasibility > tolerance_ && g_.allFinite() && J_.coeffs().allFinite())
      lambda_ = least_squares_multipliers(g_, J_);
  }
  solution_.lagrange_multipliers = lambda_;
  judge(program_, {.stationarity = HUGE_VAL, .infeasibility = tolerance_}, solution_);
  return std::move(solution_);
}

}  // namespace

Solution Sqp::minimize(const NonlinearProgram& program, const StopCriteria& stop,
                       const IterationObserver& observer) const
{
  require(program, "sqp", true, false);
  return Run(program, options_, stop, observer).minimize();
}

}  // namespace softform
