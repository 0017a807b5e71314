#include "softform/optimizers/feasible_newton.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "softform/core/interrupt.hpp"
#include "softform/core/stopwatch.hpp"
#include "softform/optimizers/counted_program.hpp"
#include "softform/optimizers/feasible_iterate.hpp"
#include "softform/optimizers/kkt_system.hpp"
#include "softform/optimizers/monitor.hpp"
#include "softform/optimizers/trust_region.hpp"

namespace softform {
namespace {

double largest_entry(const SparseMatrix& A)
{
  const double value = A.nonZeros() > 0 ? A.coeffs().abs().maxCoeff() : 0;
  return value > 0 ? value : 1;
}

class Run {
 public:
  Run(const NonlinearProgram& program, const FeasibleNewtonOptions& options, const StopCriteria& stop,
      const IterationObserver& observer)
      // Every iterate is as feasible as the programme makes it.
      : program_(program, solution_.report.evaluations),
        options_(options),
        tolerance_(stop.tolerance),
        monitor_(stop, observer, solution_.report, HUGE_VAL),
        damping_(options.damping)
  {}

  Solution minimize();

 private:
  bool start();
  bool linearize();
  void read_gauss_newton();
  bool read_exact();
  bool find_model();
  bool find_gauss_newton_step();
  bool try_damping(double damping);
  bool try_lengths();
  bool advance();
  bool advance_by_gauss_newton();
  bool advance_by_newton();
  bool is_finished(int k);

  Solution solution_;
  CountedProgram program_;
  FeasibleIterate iterate_{program_, solution_};
  const FeasibleNewtonOptions& options_;
  double tolerance_;
  Monitor monitor_;
  double damping_, unit_ = 1;  // multiple of the metric, and the unit of it
  double radius_ = 0;          // of the trust region; 0 before the first Newton step
  bool wants_newton_ = false, is_newton_ = false, has_adjoint_ = false;
  Vec g_, c_, lambda_;
  SparseMatrix H_, D_, J_, exact_;  // Hessians: Gauss-Newton's, the metric, and that of the Lagrangian
  Eigen::MatrixXd dense_;           // what Hessian of the Lagrangian is not in exact_
  KktSystem kkt_{options_.constraint_regularization};
  Vec step_;
};

bool Run::start()
{
  return iterate_.start(program_.initial_point()) ||
         !monitor_.finish(Termination::Infeasible, "no feasible point at the initial design");
}

bool Run::linearize()
{
  const Stopwatch watch(solution_.report.times.assembly);
  program_.objective_gradient(solution_.z, g_);
  program_.constraints(solution_.z, c_);
  program_.constraint_jacobian(solution_.z, J_);
  const auto adjoint = program_.adjoint_multipliers(solution_.z);
  has_adjoint_ = adjoint && adjoint->allFinite();
  if (has_adjoint_) lambda_ = *adjoint;
  return g_.allFinite() && J_.coeffs().allFinite();
}

void Run::read_gauss_newton()
{
  const Stopwatch watch(solution_.report.times.assembly);
  program_.gauss_newton_hessian(solution_.z, H_);
  program_.step_metric(solution_.z, D_);
  // The metric may be blind to some directions.
  SparseMatrix identity(D_.rows(), D_.cols());
  identity.setIdentity();
  D_ += 1e-3 * largest_entry(D_) * identity;
  unit_ = largest_entry(H_) / largest_entry(D_);
}

bool Run::read_exact()
{
  const Stopwatch watch(solution_.report.times.assembly);
  dense_ = program_.dense_curvature(solution_.z);
  return program_.lagrangian_hessian(solution_.z, lambda_, exact_);
}

// Newton's model with Gauss-Newton's system as its metric where it is wanted and there is one, else Gauss-Newton's.
bool Run::find_model()
{
  read_gauss_newton();
  is_newton_ = wants_newton_ && try_damping(options_.metric_damping) && read_exact();
  return is_newton_ || find_gauss_newton_step();
}

bool Run::try_damping(double damping)
{
  ++solution_.report.evaluations.linear_solve;
  {
    const Stopwatch watch(solution_.report.times.factorization);
    if (!kkt_.factorize(H_ + damping * unit_ * D_, J_) || !kkt_.is_convex()) return false;
  }
  const Stopwatch watch(solution_.report.times.solve);
  const KktSystem::Step step = kkt_.solve(g_, c_, options_.linear_tolerance);
  if (!step.d.allFinite() || !step.delta.allFinite()) return false;
  step_ = step.d;
  if (!has_adjoint_) lambda_ = step.delta;
  return true;
}

// Gauss-Newton's step at the smallest damping from the present one on that makes its model convex.
bool Run::find_gauss_newton_step()
{
  for (; damping_ <= options_.largest_damping; damping_ *= options_.damping_increase)
    if (try_damping(damping_)) return true;
  return false;
}

bool Run::try_lengths()
{
  const double slope = g_.dot(step_);
  const double curvature = step_.dot(H_ * step_);
  double length = 1;
  for (int halving = 0; halving <= options_.halvings; ++halving, length /= 2) {
    if (interrupted()) return false;
    if (!iterate_.accepts(length * step_)) continue;
    const double ratio = iterate_.decrease() / -(length * slope + 0.5 * length * length * curvature);
    if (length < 1)
      damping_ /= length;
    else if (ratio < 0.1)
      damping_ *= 2;
    else if (ratio > 0.5)
      damping_ = std::max(options_.smallest_damping, options_.damping_decrease * damping_);
    return true;
  }
  return false;
}

// A step length that is accepted, at a damping that is raised until there is one.
bool Run::advance_by_gauss_newton()
{
  const double before = solution_.objective;
  while (!try_lengths()) {
    damping_ *= options_.damping_increase;
    if (interrupted() || !find_gauss_newton_step()) return false;
  }
  if (iterate_.decrease() < options_.gauss_newton_decrease * before) wants_newton_ = true;
  return true;
}

// The step of the exact Hessian in the largest region that is accepted, Gauss-Newton's system being the metric.
bool Run::advance_by_newton()
{
  const Vec gradient = g_ + J_.transpose() * lambda_;
  const TrustRegionModel model(kkt_, exact_, dense_, gradient);
  if (radius_ == 0) radius_ = model.metric_norm();
  const double smallest = options_.smallest_radius * radius_;
  while (radius_ > smallest && !interrupted()) {
    const TrustRegionStep step = model.step(radius_);
    const bool is_accepted = iterate_.accepts(step.d);
    const double ratio = is_accepted ? iterate_.decrease() / step.predicted_decrease : 0;
    if (ratio > 0.75 && step.is_on_boundary) radius_ *= 2;
    if (ratio < 0.25) radius_ = 0.25 * step.norm;
    if (is_accepted) return true;
  }
  return false;
}

bool Run::advance() { return is_newton_ ? advance_by_newton() : advance_by_gauss_newton(); }

bool Run::is_finished(int k)
{
  const double infeasibility = c_.size() > 0 ? c_.cwiseAbs().maxCoeff() : 0;
  const Vec gradient = g_ + J_.transpose() * lambda_;
  const double stationarity = gradient.cwiseAbs().maxCoeff();
  Iterate iterate{k, solution_.objective, stationarity, infeasibility, iterate_.step_norm(), 0};
  iterate.damping = damping_;
  const bool must_stop = monitor_.record(iterate, &solution_.z);
  if (stationarity <= tolerance_)
    return monitor_.finish(Termination::Converged, fmt::format("stationary to {:.1e}", stationarity));
  return must_stop;
}

Solution Run::minimize()
{
  if (!start()) return std::move(solution_);
  for (int k = 0;; ++k) {
    if (!linearize()) {
      monitor_.finish(Termination::NotFinite, "a derivative is not finite");
      break;
    }
    if (!find_model()) {
      monitor_.finish(Termination::Stalled, "no damping makes the model convex");
      break;
    }
    if (is_finished(k)) break;
    if (advance()) continue;
    if (interrupted())
      monitor_.finish(Termination::Interrupted, fmt::format("interrupted after {} iterations", k));
    else
      monitor_.finish(Termination::Stalled, "no step decreases the objective, however small");
    break;
  }
  solution_.lagrange_multipliers = lambda_;
  return std::move(solution_);
}

}  // namespace

Solution FeasibleNewton::minimize(const NonlinearProgram& program, const StopCriteria& stop,
                                  const IterationObserver& observer) const
{
  return Run(program, options_, stop, observer).minimize();
}

}  // namespace softform
