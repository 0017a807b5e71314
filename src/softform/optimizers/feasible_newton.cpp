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

namespace softform {
namespace {

enum class HessianModel { GaussNewton, Exact };

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
  void read_hessian(HessianModel model);
  bool find_first_step();
  bool find_step();
  bool try_damping();
  bool try_lengths();
  bool advance();
  bool is_finished(int k);

  Solution solution_;
  CountedProgram program_;
  FeasibleIterate iterate_{program_, solution_};
  const FeasibleNewtonOptions& options_;
  double tolerance_;
  Monitor monitor_;
  double damping_, unit_ = 1;  // multiple of the metric, and the unit of it
  bool wants_exact_ = false, is_exact_ = false, has_adjoint_ = false;
  Vec g_, c_, lambda_;
  SparseMatrix H_, D_, J_;
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

void Run::read_hessian(HessianModel model)
{
  const Stopwatch watch(solution_.report.times.assembly);
  is_exact_ =
      model == HessianModel::Exact && lambda_.size() > 0 && program_.lagrangian_hessian(solution_.z, lambda_, H_);
  if (is_exact_) return;
  program_.gauss_newton_hessian(solution_.z, H_);
  program_.step_metric(solution_.z, D_);
  // The metric may be blind to some directions.
  SparseMatrix identity(D_.rows(), D_.cols());
  identity.setIdentity();
  D_ += 1e-3 * largest_entry(D_) * identity;
  unit_ = largest_entry(H_) / largest_entry(D_);
}

// The exact Hessian where it is convex along the constraints as it is, else Gauss-Newton's: where states change their
// kind (wrinkles come and go) the exact one has directions of strong negative curvature, and a shift that covers them
// would hold up all others.
bool Run::find_first_step()
{
  read_hessian(HessianModel::GaussNewton);
  if (wants_exact_) {
    read_hessian(HessianModel::Exact);
    if (is_exact_ && try_damping()) return true;
    if (is_exact_) read_hessian(HessianModel::GaussNewton);
  }
  return find_step();
}

bool Run::try_damping()
{
  ++solution_.report.evaluations.linear_solve;
  {
    const Stopwatch watch(solution_.report.times.factorization);
    if (!kkt_.factorize(H_ + damping_ * unit_ * D_, J_) || !kkt_.is_convex()) return false;
  }
  const Stopwatch watch(solution_.report.times.solve);
  const KktSystem::Step step = kkt_.solve(g_, c_, options_.linear_tolerance);
  if (!step.d.allFinite() || !step.delta.allFinite()) return false;
  step_ = step.d;
  if (!has_adjoint_) lambda_ = step.delta;
  return true;
}

// The step at the smallest damping from the present one on that makes the model convex.
bool Run::find_step()
{
  for (; damping_ <= options_.largest_damping; damping_ *= options_.damping_increase)
    if (try_damping()) return true;
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
bool Run::advance()
{
  const double before = solution_.objective;
  while (!try_lengths()) {
    damping_ *= options_.damping_increase;
    if (interrupted() || !find_step()) return false;
  }
  if (iterate_.decrease() < options_.gauss_newton_decrease * before) wants_exact_ = true;
  return true;
}

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
    if (!find_first_step()) {
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
