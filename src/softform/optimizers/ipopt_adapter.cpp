#include "softform/optimizers/ipopt_adapter.hpp"

#include <IpIpoptApplication.hpp>
#include <IpIpoptCalculatedQuantities.hpp>
#include <IpIpoptData.hpp>
#include <IpTNLP.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "softform/optimizers/counted_program.hpp"
#include "softform/optimizers/monitor.hpp"
#include "softform/optimizers/optimality.hpp"

namespace softform {
namespace {

using Ipopt::Index;
using Ipopt::Number;

void write_pattern(const SparseMatrix& A, bool lower_only, Index* rows, Index* columns)
{
  for (int j = 0; j < A.outerSize(); ++j) {
    for (SparseMatrix::InnerIterator entry(A, j); entry; ++entry) {
      if (lower_only && entry.row() < j) continue;
      *rows++ = static_cast<Index>(entry.row());
      *columns++ = j;
    }
  }
}

void write_values(const SparseMatrix& A, bool lower_only, Number* values)
{
  for (int j = 0; j < A.outerSize(); ++j)
    for (SparseMatrix::InnerIterator entry(A, j); entry; ++entry)
      if (!lower_only || entry.row() >= j) *values++ = entry.value();
}

int count_lower(const SparseMatrix& A)
{
  int count = 0;
  for (int j = 0; j < A.outerSize(); ++j)
    for (SparseMatrix::InnerIterator entry(A, j); entry; ++entry) count += entry.row() >= j;
  return count;
}

/// A NonlinearProgram as IPOPT asks for it.
class Program : public Ipopt::TNLP {
 public:
  Program(const CountedProgram& program, Monitor& monitor, Solution& solution)
      : program_(program), monitor_(monitor), solution_(solution)
  {
    z0_ = program.initial_point().cwiseMax(program.lower_bounds()).cwiseMin(program.upper_bounds());
    solution.z = z0_;
    J_.resize(0, program.variable_count());
    if (program.constraint_count() > 0) program.constraint_jacobian(z0_, J_);
    has_hessian_ = program.lagrangian_hessian(z0_, Vec::Zero(program.constraint_count()), H_);
  }

  bool has_hessian() const { return has_hessian_; }
  bool was_stopped() const { return was_stopped_; }

  bool get_nlp_info(Index& n, Index& m, Index& jacobian_entries, Index& hessian_entries, IndexStyleEnum& style) override
  {
    n = program_.variable_count();
    m = program_.constraint_count();
    jacobian_entries = static_cast<Index>(J_.nonZeros());
    hessian_entries = has_hessian_ ? count_lower(H_) : 0;
    style = C_STYLE;
    return true;
  }

  bool get_bounds_info(Index n, Number* lower, Number* upper, Index m, Number* c_lower, Number* c_upper) override
  {
    Eigen::Map<Vec>(lower, n) = program_.lower_bounds().cwiseMax(-infinite);
    Eigen::Map<Vec>(upper, n) = program_.upper_bounds().cwiseMin(infinite);
    std::fill(c_lower, c_lower + m, 0);
    std::fill(c_upper, c_upper + m, 0);
    return true;
  }

  bool get_starting_point(Index n, bool, Number* z, bool, Number*, Number*, Index, bool, Number*) override
  {
    Eigen::Map<Vec>(z, n) = z0_;
    return true;
  }

  bool eval_f(Index n, const Number* z, bool, Number& f) override
  {
    f = program_.objective(Eigen::Map<const Vec>(z, n));
    return std::isfinite(f);
  }

  bool eval_grad_f(Index n, const Number* z, bool, Number* gradient) override
  {
    Vec g;
    program_.objective_gradient(Eigen::Map<const Vec>(z, n), g);
    Eigen::Map<Vec>(gradient, n) = g;
    return g.allFinite();
  }

  bool eval_g(Index n, const Number* z, bool, Index m, Number* values) override
  {
    if (m == 0) return true;
    Vec c;
    program_.constraints(Eigen::Map<const Vec>(z, n), c);
    Eigen::Map<Vec>(values, m) = c;
    return c.allFinite();
  }

  bool eval_jac_g(Index n, const Number* z, bool, Index m, Index, Index* rows, Index* columns, Number* values) override
  {
    if (values == nullptr) {
      write_pattern(J_, false, rows, columns);
      return true;
    }
    if (m > 0) program_.constraint_jacobian(Eigen::Map<const Vec>(z, n), J_);
    write_values(J_, false, values);
    return J_.coeffs().allFinite();
  }

  // IPOPT weighs the objective: the Hessian of s f + lambda . c is that of f + lambda . c plus (s - 1) times that of f.
  bool eval_h(Index n, const Number* z, bool, Number weight, Index m, const Number* multipliers, bool, Index,
              Index* rows, Index* columns, Number* values) override
  {
    if (values == nullptr) {
      write_pattern(H_, true, rows, columns);
      return true;
    }
    const Eigen::Map<const Vec> point(z, n), lambda(multipliers, m);
    program_.lagrangian_hessian(point, lambda, H_);
    if (weight != 1) {
      SparseMatrix H_f;
      program_.lagrangian_hessian(point, Vec::Zero(m), H_f);
      H_.coeffs() += (weight - 1) * H_f.coeffs();
    }
    write_values(H_, true, values);
    return H_.coeffs().allFinite();
  }

  bool intermediate_callback(Ipopt::AlgorithmMode mode, Index k, Number f, Number infeasibility, Number stationarity,
                             Number, Number step, Number, Number, Number, Index, const Ipopt::IpoptData*,
                             Ipopt::IpoptCalculatedQuantities*) override
  {
    // Values in the restoration phase are those of another programme.
    if (mode == Ipopt::RestorationPhaseMode && !solution_.report.trace.empty()) {
      f = solution_.report.trace.back().objective;
    }
    // One factorisation a step at least; those of IPOPT's inertia corrections are not seen.
    solution_.report.evaluations.linear_solve += k - steps_;
    steps_ = k;
    was_stopped_ = monitor_.record({k, f, stationarity, infeasibility, step, 0});
    return !was_stopped_;
  }

  void finalize_solution(Ipopt::SolverReturn, Index n, const Number* z, const Number*, const Number*, Index m,
                         const Number*, const Number* lambda, Number, const Ipopt::IpoptData*,
                         Ipopt::IpoptCalculatedQuantities*) override
  {
    solution_.z = Eigen::Map<const Vec>(z, n);
    solution_.lagrange_multipliers = Eigen::Map<const Vec>(lambda, m);
  }

 private:
  static constexpr double infinite = 2e19;  // IPOPT takes anything beyond 1e19 as no bound

  const CountedProgram& program_;
  Monitor& monitor_;
  Solution& solution_;
  Vec z0_;
  SparseMatrix J_, H_;
  int steps_ = 0;
  bool has_hessian_ = false, was_stopped_ = false;
};

void conclude(Ipopt::ApplicationReturnStatus status, Monitor& monitor)
{
  switch (status) {
    case Ipopt::Solve_Succeeded: monitor.finish(Termination::Converged, "IPOPT: converged"); break;
    case Ipopt::Solved_To_Acceptable_Level:
      monitor.finish(Termination::Converged, "IPOPT: converged to its acceptable level");
      break;
    case Ipopt::Infeasible_Problem_Detected:
      monitor.finish(Termination::Infeasible, "IPOPT: a point of least infeasibility");
      break;
    case Ipopt::Diverging_Iterates: monitor.finish(Termination::NotFinite, "IPOPT: the iterates diverge"); break;
    case Ipopt::Invalid_Number_Detected:
      monitor.finish(Termination::NotFinite, "IPOPT: a function is not finite");
      break;
    case Ipopt::Maximum_Iterations_Exceeded:
      monitor.finish(Termination::IterationLimit, "IPOPT: iteration limit");
      break;
    case Ipopt::Maximum_CpuTime_Exceeded: monitor.finish(Termination::TimeLimit, "IPOPT: time limit"); break;
    case Ipopt::Not_Enough_Degrees_Of_Freedom:
      monitor.finish(Termination::Stalled, "IPOPT: more constraints than variables");
      break;
    default: monitor.finish(Termination::Stalled, fmt::format("IPOPT: status {}", static_cast<int>(status)));
  }
}

void set_options(const IpoptOptions& options, const StopCriteria& stop, bool has_hessian, Ipopt::OptionsList& list)
{
  list.SetStringValue("sb", "yes");
  list.SetIntegerValue("print_level", 0);
  list.SetNumericValue("tol", options.tolerance_factor * stop.tolerance);
  list.SetIntegerValue("max_iter", stop.max_iterations);
  list.SetNumericValue("max_cpu_time", std::max(1e-6, stop.max_time_s));
  // Bounds are bounds: by default IPOPT widens them.
  list.SetNumericValue("bound_relax_factor", 0);
  list.SetStringValue("hessian_approximation", has_hessian ? "exact" : "limited-memory");
}

}  // namespace

Solution IpoptAdapter::minimize(const NonlinearProgram& program, const StopCriteria& stop,
                                const IterationObserver& observer) const
{
  require(program, "ipopt", true, true);
  Solution solution;
  const CountedProgram counted(program, solution.report.evaluations);
  Monitor monitor(stop, observer, solution.report, Tolerances{}.infeasibility);
  // IPOPT counts references to it.
  auto* view = new Program(counted, monitor, solution);
  const Ipopt::SmartPtr<Ipopt::TNLP> owner(view);
  const Ipopt::SmartPtr<Ipopt::IpoptApplication> application = IpoptApplicationFactory();
  set_options(options_, stop, view->has_hessian(), *application->Options());
  application->Initialize("");  // no options file
  const Ipopt::ApplicationReturnStatus status = application->OptimizeTNLP(owner);
  if (!view->was_stopped()) conclude(status, monitor);
  judge(program, {.stationarity = view->was_stopped() ? HUGE_VAL : Tolerances{}.stationarity}, solution);
  return solution;
}

}  // namespace softform
