// Everything that needs NLopt's header.
#include <nlopt.h>

#include <cmath>
#include <memory>

#include <fmt/format.h>

#include "softform/fitting/least_squares.hpp"

namespace softform {
namespace {

struct Objective {
  const LeastSquaresProblem& problem;
  Vec residuals;
  int evaluations = 0;

  double operator()(ConstVec z)
  {
    ++evaluations;
    return problem.evaluate(z, residuals, nullptr) ? 0.5 * residuals.squaredNorm() : HUGE_VAL;
  }

  static double call(unsigned n, const double* z, double*, void* objective)
  {
    return (*static_cast<Objective*>(objective))(Eigen::Map<const Vec>(z, n));
  }
};

using Handle = std::unique_ptr<std::remove_pointer_t<nlopt_opt>, decltype(&nlopt_destroy)>;

Handle make_handle(nlopt_algorithm algorithm, Objective& objective, int max_evaluations)
{
  const auto n = static_cast<unsigned>(objective.problem.parameter_count());
  Handle handle(nlopt_create(algorithm, n), nlopt_destroy);
  nlopt_set_min_objective(handle.get(), Objective::call, &objective);
  nlopt_set_maxeval(handle.get(), max_evaluations);
  return handle;
}

/// One run of a local method from z, with steps of that size; z and the cost only get better.
void improve(nlopt_algorithm algorithm, Objective& objective, double step, Vec& z, double& cost)
{
  const Handle handle = make_handle(algorithm, objective, 4000 * static_cast<int>(z.size()));
  nlopt_set_ftol_rel(handle.get(), 1e-15);
  nlopt_set_xtol_rel(handle.get(), 1e-13);
  const Vec steps = step * objective.problem.scale(z);
  nlopt_set_initial_step(handle.get(), steps.data());
  Vec trial = z;
  double trial_cost = cost;
  if (nlopt_optimize(handle.get(), trial.data(), &trial_cost) == NLOPT_INVALID_ARGS) return;
  if (trial_cost < cost) {
    z = trial;
    cost = trial_cost;
  }
}

}  // namespace

LeastSquaresSolution minimize_by_nlopt(const LeastSquaresProblem& problem, ConstVec start,
                                       const LeastSquaresOptions& options)
{
  Objective objective{problem, {}};
  LeastSquaresSolution solution;
  solution.z = start;
  solution.cost = objective(start);
  if (!std::isfinite(solution.cost)) {
    solution.report.termination = Termination::NotFinite;
    solution.report.message = "the residuals are not finite at the start";
    return solution;
  }
  // Sbplx (Rowan's subspace simplex) gets near whatever the start; Bobyqa's quadratic model then converges where a
  // simplex crawls. Both restarted, with smaller steps, until neither gains.
  double step = 0.3;
  int round = 0, idle = 0;
  for (; round < 60 && idle < 3 && objective.evaluations < 100 * options.max_iterations; ++round, step *= 0.5) {
    const double before = solution.cost;
    improve(NLOPT_LN_SBPLX, objective, step, solution.z, solution.cost);
    improve(NLOPT_LN_BOBYQA, objective, 0.1 * step, solution.z, solution.cost);
    solution.report.trace.push_back({round, solution.cost, 0, 0, step, 0});
    idle = solution.cost < before * (1 - 1e-10) ? 0 : idle + 1;
  }
  solution.report.evaluations.value = objective.evaluations;
  solution.report.termination = idle < 3 ? Termination::IterationLimit : Termination::Converged;
  solution.report.message = fmt::format("{} evaluations", objective.evaluations);
  judge(problem, solution);
  return solution;
}

Vec search_by_nlopt(const LeastSquaresProblem& problem, ConstVec lower, ConstVec upper, unsigned seed)
{
  Objective objective{problem, {}};
  const Vec low = lower, high = upper;
  nlopt_srand(seed);  // Price's controlled random search, repeatable
  const Handle handle = make_handle(NLOPT_GN_CRS2_LM, objective, 3000 * problem.parameter_count());
  nlopt_set_lower_bounds(handle.get(), low.data());
  nlopt_set_upper_bounds(handle.get(), high.data());
  nlopt_set_ftol_rel(handle.get(), 1e-6);
  Vec z = 0.5 * (low + high);
  double cost = 0;
  nlopt_optimize(handle.get(), z.data(), &cost);
  return z;
}

}  // namespace softform
