#include "softform/optimizers/nlopt_adapter.hpp"

#include <nlopt.h>

#include <cmath>
#include <memory>

#include <fmt/format.h>

#include "softform/optimizers/counted_program.hpp"
#include "softform/optimizers/monitor.hpp"
#include "softform/optimizers/optimality.hpp"

namespace softform {
namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Handle = std::unique_ptr<std::remove_pointer_t<nlopt_opt>, decltype(&nlopt_destroy)>;

struct Method {
  const char* name;
  nlopt_algorithm algorithm;
  bool takes_constraints;
};

Method describe(NloptMethod method)
{
  switch (method) {
    case NloptMethod::Slsqp: return {"nlopt_slsqp", NLOPT_LD_SLSQP, true};
    case NloptMethod::Mma: return {"nlopt_mma", NLOPT_LD_MMA, false};
    case NloptMethod::Lbfgs: return {"nlopt_lbfgs", NLOPT_LD_LBFGS, false};
    case NloptMethod::AugLag: return {"nlopt_auglag", NLOPT_AUGLAG, true};
  }
  return {};
}

const char* explain(nlopt_result result)
{
  switch (result) {
    case NLOPT_SUCCESS: return "success";
    case NLOPT_FTOL_REACHED: return "the objective changes no more";
    case NLOPT_XTOL_REACHED: return "the variables change no more";
    case NLOPT_ROUNDOFF_LIMITED: return "round-off";
    case NLOPT_OUT_OF_MEMORY: return "out of memory";
    case NLOPT_INVALID_ARGS: return "invalid arguments";
    default: return "generic failure";
  }
}

/// What NLopt calls back.
class Run {
 public:
  Run(const NonlinearProgram& program, const StopCriteria& stop, const IterationObserver& observer)
      : program_(program, solution_.report.evaluations), stop_(stop), monitor_(stop_, observer, solution_.report)
  {
    // NLopt counts evaluations and tests progress itself.
    stop_.relative_decrease = 0;
    c_ = Vec::Zero(program.constraint_count());
  }

  Solution minimize(const Method& method, const NloptOptions& options);

 private:
  Handle make(nlopt_algorithm algorithm, const NloptOptions& options) const;
  void explain_end(nlopt_result result);
  double objective(ConstVec z, double* gradient);
  void constraints(ConstVec z, double* values, double* jacobian);

  static double call_objective(unsigned n, const double* z, double* gradient, void* run)
  {
    return static_cast<Run*>(run)->objective(Eigen::Map<const Vec>(z, n), gradient);
  }
  static void call_constraints(unsigned, double* values, unsigned n, const double* z, double* jacobian, void* run)
  {
    static_cast<Run*>(run)->constraints(Eigen::Map<const Vec>(z, n), values, jacobian);
  }

  Solution solution_;
  CountedProgram program_;
  StopCriteria stop_;
  Monitor monitor_;
  nlopt_opt outer_ = nullptr;
  bool was_stopped_ = false;
  int gradients_ = 0;
  Vec c_, last_;
};

// Values that are not finite become +infinity, which line searches refuse; where it does not, the end is judged anyway.
double Run::objective(ConstVec z, double* gradient)
{
  const double f = program_.objective(z);
  if (gradient == nullptr) return std::isfinite(f) ? f : HUGE_VAL;
  Vec g;
  program_.objective_gradient(z, g);
  Eigen::Map<Vec>(gradient, z.size()) = g;
  if (c_.size() > 0) program_.constraints(z, c_);
  const double infeasibility = c_.size() > 0 ? c_.lpNorm<Eigen::Infinity>() : 0;
  const double step = last_.size() > 0 ? (z - last_).norm() : 0;
  last_ = z;
  // A line search may look at a point that is not finite; only a start that is not ends the run.
  const bool is_finite = std::isfinite(f) && g.allFinite() && c_.allFinite();
  if (is_finite || gradients_ == 0) {
    if (monitor_.record({gradients_, f, is_finite ? 0 : std::nan(""), infeasibility, step, 0})) {
      was_stopped_ = true;
      nlopt_force_stop(outer_);
    }
    ++gradients_;
  }
  return is_finite ? f : HUGE_VAL;
}

void Run::constraints(ConstVec z, double* values, double* jacobian)
{
  Vec c;
  program_.constraints(z, c);
  Eigen::Map<Vec>(values, c.size()) = c;
  if (jacobian == nullptr) return;
  SparseMatrix J;
  program_.constraint_jacobian(z, J);
  Eigen::Map<RowMajor>(jacobian, J.rows(), J.cols()) = RowMajor(J);
}

Handle Run::make(nlopt_algorithm algorithm, const NloptOptions& options) const
{
  Handle handle(nlopt_create(algorithm, static_cast<unsigned>(program_.variable_count())), nlopt_destroy);
  nlopt_set_lower_bounds(handle.get(), program_.lower_bounds().data());
  nlopt_set_upper_bounds(handle.get(), program_.upper_bounds().data());
  nlopt_set_xtol_rel(handle.get(), options.relative_tolerance);
  nlopt_set_maxtime(handle.get(), stop_.max_time_s > 0 ? stop_.max_time_s : 1e-9);
  return handle;
}

Solution Run::minimize(const Method& method, const NloptOptions& options)
{
  stop_.max_iterations *= options.evaluations_per_iteration;
  const Handle handle = make(method.algorithm, options);
  outer_ = handle.get();
  nlopt_set_min_objective(outer_, call_objective, this);
  if (method.algorithm == NLOPT_AUGLAG) {
    const Handle inner = make(NLOPT_LD_LBFGS, options);
    nlopt_set_local_optimizer(outer_, inner.get());
  }
  if (c_.size() > 0) {
    const Vec tolerances = Vec::Constant(c_.size(), options.feasibility_tolerance);
    nlopt_add_equality_mconstraint(outer_, static_cast<unsigned>(c_.size()), call_constraints, this, tolerances.data());
  }
  Vec& z = solution_.z = program_.initial_point().cwiseMax(program_.lower_bounds()).cwiseMin(program_.upper_bounds());
  double f = 0;
  const nlopt_result result = nlopt_optimize(outer_, z.data(), &f);
  if (!was_stopped_) explain_end(result);
  judge(program_, {}, solution_);
  return std::move(solution_);
}

// NLopt says "failure" where a line search ends at an optimum, too: judge() decides.
void Run::explain_end(nlopt_result result)
{
  if (result == NLOPT_MAXTIME_REACHED)
    monitor_.finish(Termination::TimeLimit, fmt::format("{:.0f} s", stop_.max_time_s));
  else
    monitor_.finish(Termination::Converged, fmt::format("NLopt: {}", explain(result)));
}

}  // namespace

Solution NloptAdapter::minimize(const NonlinearProgram& program, const StopCriteria& stop,
                                const IterationObserver& observer) const
{
  const Method method = describe(method_);
  require(program, method.name, method.takes_constraints, true);
  return Run(program, stop, observer).minimize(method, options_);
}

}  // namespace softform
