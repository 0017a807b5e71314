#include "comparison.hpp"

#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include "softform/equilibrium/newton.hpp"
#include "softform/io/text_file.hpp"
#include "softform/optimizers/least_squares_program.hpp"
#include "softform/optimizers/optimality.hpp"
#include "softform/optimizers/registry.hpp"

namespace softform {
namespace {

constexpr double feasible_below = 1e-6;  // the balance of forces, of a fully unbalanced vertex
constexpr double close_to_best = 1.05;

bool has_bounds(const NonlinearProgram& program)
{
  return program.lower_bounds().maxCoeff() > -HUGE_VAL || program.upper_bounds().minCoeff() < HUGE_VAL;
}

bool takes(const OptimizerEntry& method, const NonlinearProgram& program)
{
  return (method.takes_constraints || program.constraint_count() == 0) &&
         (method.takes_bounds || !has_bounds(program)) &&
         (!method.needs_residuals || dynamic_cast<const LeastSquaresProgram*>(&program) != nullptr) &&
         (!method.needs_restoration || program.restore(program.initial_point()));
}

// False where another entry of the registry does the very same: without constraints, penalties are gradient projection
// and NLopt's augmented Lagrangian is its L-BFGS; without an exact Hessian, the exact augmented Lagrangian is the
// Gauss-Newton one.
bool is_distinct(const std::string& method, const NonlinearProgram& program)
{
  if (program.constraint_count() == 0)
    return !method.starts_with("augmented_") && method != "quadratic_penalty" && method != "nlopt_auglag";
  SparseMatrix H;
  return method != "augmented_lagrangian" ||
         program.lagrangian_hessian(program.initial_point(), Vec::Zero(program.constraint_count()), H);
}

// Dense quadratic programmes cost the cube of the variables: some hundred take seconds a step.
bool is_too_large(const std::string& method, const NonlinearProgram& program)
{
  return method == "nlopt_slsqp" && program.variable_count() > 100;
}

// Runs the method; the times in its trace are CPU seconds, and its limit is one of these.
Outcome minimize(Run& run, const OptimizerEntry& method, const NonlinearProgram& program, StopCriteria stop,
                 double largest_cpu_s)
{
  Outcome outcome;
  std::vector<double> cpu_s;
  const auto show = run.observer();
  const double begin = Run::cpu_s();
  outcome.solution = method.make()->minimize(program, stop, [&](const Iterate& iterate) {
    cpu_s.push_back(Run::cpu_s() - begin);
    return show(iterate) && cpu_s.back() < largest_cpu_s;
  });
  outcome.cpu_s = Run::cpu_s() - begin;
  Report& report = outcome.solution.report;
  if (report.termination == Termination::Interrupted && outcome.cpu_s >= largest_cpu_s)
    report.termination = Termination::TimeLimit;
  for (std::size_t k = 0; k < std::min(cpu_s.size(), report.trace.size()); ++k) report.trace[k].elapsed_s = cpu_s[k];
  return outcome;
}

// The state at the design that was found, solved for again: stable, or none.
void resolve(const Instance& instance, Outcome& outcome)
{
  outcome.objective = outcome.solution.objective;
  if (!instance.full) return;  // no state
  const auto program = instance.full();
  const bool is_reduced = outcome.formulation == "reduced";
  Vec z = outcome.solution.z;
  if (is_reduced) {
    z = program->initial_point();
    z.tail(outcome.solution.z.size()) = outcome.solution.z;
  }
  const std::optional<Vec> restored = program->restore(z);
  outcome.has_equilibrium = restored.has_value();
  const Eigen::Index states = program->constraint_count();
  if (restored) {
    outcome.objective = program->objective(*restored);
    if (!is_reduced)
      outcome.moved = (*restored - z).lpNorm<Eigen::Infinity>() / z.head(states).lpNorm<Eigen::Infinity>();
  }
  if (!instance.has_potential || (is_reduced && !restored)) return;
  SparseMatrix J;
  SparseFactorization factorization;
  program->constraint_jacobian(is_reduced ? *restored : z, J);
  outcome.negative_eigenvalues = count_negative_eigenvalues(SparseMatrix(J.leftCols(states)), factorization);
}

std::vector<Outcome> run_all(Run& run, const Instance& instance, const StopCriteria& stop,
                             const std::set<std::string>& given_up)
{
  std::vector<Outcome> outcomes;
  for (const auto& [formulation, make] : {std::pair{"full", instance.full}, std::pair{"reduced", instance.reduced}}) {
    if (!make) continue;
    for (const OptimizerEntry& method : optimizers()) {
      const auto program = make();
      if (given_up.contains(method.name + "_" + formulation)) continue;
      if (!takes(method, *program) || !is_distinct(method.name, *program) || is_too_large(method.name, *program))
        continue;
      run.step(fmt::format("{}: {}, {}", instance.name, method.name, formulation));
      Outcome outcome = minimize(run, method, *program, stop, instance.largest_cpu_s);
      outcome.method = method.name;
      outcome.formulation = formulation;
      run.log(outcome.solution.report.message);
      resolve(instance, outcome);
      run.trace("trace_" + instance.name + "_" + outcome.name(), outcome.solution.report.trace);
      outcomes.push_back(std::move(outcome));
    }
  }
  return outcomes;
}

double best_objective(const std::vector<Outcome>& outcomes)
{
  double best = HUGE_VAL;
  for (const Outcome& outcome : outcomes)
    if (outcome.has_equilibrium && outcome.objective < best) best = outcome.objective;
  return best;
}

void find_reached(double best, Outcome& outcome)
{
  for (const Iterate& iterate : outcome.solution.report.trace) {
    if (!(iterate.objective <= close_to_best * best && iterate.infeasibility <= feasible_below)) continue;
    outcome.reached_s = iterate.elapsed_s;
    outcome.reached_solves = iterate.linear_solves;
    return;
  }
}

// How a run ended in one word. Most stopping rules end a run whose objective falls no more: whether that is an optimum
// is another question.
std::string ending(const Outcome& outcome)
{
  const Termination termination = outcome.solution.report.termination;
  const bool is_stationary = outcome.last().stationarity <= Tolerances{}.stationarity;
  return termination == Termination::Converged && !is_stationary ? "slow progress" : to_string(termination);
}

// One row of the table of outcomes.
std::string row(const Instance& instance, const Outcome& outcome)
{
  const Solution& solution = outcome.solution;
  return fmt::format("{},{},{},{},{:.6g},{:.2g},{:.2g},{},{:.3g},{:.3g},{:.3g},{},{},{:.2g},{:.6g}\n", instance.name,
                     outcome.formulation, outcome.method, ending(outcome), solution.objective,
                     outcome.last().infeasibility, outcome.last().stationarity,
                     solution.report.evaluations.linear_solve, outcome.cpu_s, outcome.reached_solves, outcome.reached_s,
                     outcome.negative_eigenvalues, int(outcome.has_equilibrium), outcome.moved, outcome.objective);
}

// What is claimed of balloons.
void claims(Run& run, const Instance& instance, const std::vector<Outcome>& outcomes, double best)
{
  double reached_s = NAN, reached_solves = NAN;
  for (const Outcome& outcome : outcomes) {
    if (outcome.formulation != "full") continue;
    const std::string suffix = outcome.method + "_" + instance.name;
    run.metric("over_best_" + suffix, outcome.objective / best, "1");
    run.metric("infeasibility_" + suffix, outcome.last().infeasibility, "1");
    if (outcome.method != "reduced_gauss_newton" || !std::isfinite(outcome.reached_s)) continue;
    reached_s = outcome.reached_s;
    reached_solves = outcome.reached_solves;
  }
  double ahead_s = 0, ahead_solves = 0;
  for (const Outcome& outcome : outcomes) {
    ahead_s += outcome.reached_s < reached_s;
    ahead_solves += outcome.reached_solves < reached_solves;
  }
  run.metric("ahead_in_cpu_" + instance.name, std::isnan(reached_s) ? NAN : ahead_s, "1");
  run.metric("ahead_in_solves_" + instance.name, std::isnan(reached_s) ? NAN : ahead_solves, "1");
}

// The largest relative difference of the objectives that independent methods found.
void agreement(Run& run, const Instance& instance, const std::vector<Outcome>& outcomes,
               const std::vector<std::string>& names)
{
  double least = HUGE_VAL, largest = -HUGE_VAL;
  for (const Outcome& outcome : outcomes) {
    if (std::find(names.begin(), names.end(), outcome.name()) == names.end()) continue;
    least = std::min(least, outcome.objective);
    largest = std::isnan(outcome.objective) ? NAN : std::max(largest, outcome.objective);
  }
  run.metric("disagreement_" + instance.name, (largest - least) / least, "1");
}

}  // namespace

std::pair<std::vector<Outcome>, double> Comparison::compare(const Instance& instance, double relative_decrease)
{
  const StopCriteria stop{.max_iterations = run_.by_size(60, 500), .relative_decrease = relative_decrease};
  std::vector<Outcome> outcomes =
      run_all(run_, instance, stop, instance.has_potential ? given_up_ : std::set<std::string>{});
  const double best = best_objective(outcomes);
  for (Outcome& outcome : outcomes) {
    find_reached(best, outcome);
    table_ += row(instance, outcome);
  }
  write_text(run_.path("outcomes.csv"), table_);
  return {std::move(outcomes), best};
}

void Comparison::balloon(const Instance& instance)
{
  const auto [outcomes, best] = compare(instance, 1e-6);
  for (const Outcome& outcome : outcomes)
    if (!std::isfinite(outcome.reached_s)) given_up_.insert(outcome.name());
  claims(run_, instance, outcomes, best);
}

void Comparison::sheet(const Instance& instance)
{
  const auto outcomes = compare(instance, 0).first;
  agreement(run_, instance, outcomes, {"augmented_lagrangian_gauss_newton_full", "reduced_gauss_newton_reduced"});
}

void Comparison::rubber(const Instance& instance)
{
  const auto outcomes = compare(instance, 0).first;
  agreement(run_, instance, outcomes, {"gradient_projection_reduced", "nlopt_lbfgs_reduced"});
}

void Comparison::layout(const Instance& instance)
{
  const auto [outcomes, best] = compare(instance, 1e-7);
  run_.metric("best_objective_" + instance.name, best, "1");
  agreement(run_, instance, outcomes, {"nlopt_mma_reduced", "nlopt_lbfgs_reduced"});
}

}  // namespace softform
