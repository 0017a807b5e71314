// Purpose: the optimisers of thesis section 3.2, and those that a user would reach for, on the same designs with the
// same stopping rules and counters (3.39):
//     min E(x) + R(p)   subject to   f(x, p) = 0,
// in the full space z = (x, p), or in the design p alone with x(p) from an equilibrium solve. What each returns is
// judged by the stable equilibrium that is solved for again from there: how far it moves, and its objective.
// Claim: on balloons the reduced Gauss-Newton method is the first to come within 5 % of the best objective that any
// method finds, in time and in factorisations.

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "softform/equilibrium/volume_control.hpp"
#include "softform/experiment/experiment.hpp"
#include "softform/experiment/run.hpp"
#include "softform/fitting/least_squares_as_program.hpp"
#include "softform/fitting/shape_fit.hpp"
#include "softform/fitting/trust.hpp"
#include "softform/inverse/rest_shape_design.hpp"
#include "softform/io/text_file.hpp"
#include "softform/materials/material_file.hpp"
#include "softform/mesh/shapes.hpp"
#include "softform/objectives/edge_dihedral.hpp"
#include "softform/optimizers/optimality.hpp"
#include "softform/optimizers/registry.hpp"

namespace {

using namespace softform;

constexpr double feasible_below = 1e-6;  // the balance of forces, of a fully unbalanced vertex
constexpr double close_to_best = 1.05;

// One problem, in the full space, in the design alone, or both. Every method gets a programme of its own: programmes
// remember where they were evaluated last.
struct Instance {
  std::string name;
  double largest_cpu_s = HUGE_VAL;
  std::function<std::unique_ptr<NonlinearProgram>()> full, reduced;
  bool has_potential = false;  // its stability is the sign of the eigenvalues of df/dx
};

// What a method made of an instance.
struct Outcome {
  std::string formulation, method;
  Solution solution;
  double cpu_s = 0;
  // Of the result, and of the stable equilibrium at its design, where there is one.
  int negative_eigenvalues = -1;  // of df/dx at the result; -1 is not known
  bool has_equilibrium = true;
  double moved = 0, objective = NAN;
  // Until the best objective is reached within 5 %, balanced; infinite where it never is.
  double reached_s = HUGE_VAL, reached_solves = HUGE_VAL;

  std::string name() const { return method + "_" + formulation; }
  const Iterate& last() const { return solution.report.trace.back(); }
};

// A target for the quick size: three different axes.
TriangleMesh ellipsoid(int vertex_count)
{
  TriangleMesh mesh = irregular_sphere(1, vertex_count);
  mesh.vertices.col(0) *= 1.25;
  mesh.vertices.col(2) *= 0.8;
  return mesh;
}

// A rest shape (chapter 4), from the downscaled target. Without the collision and volume terms, which have no exact
// Hessian.
Instance balloon(const std::string& name, const TriangleMesh& shape, const std::shared_ptr<const Material>& silicone)
{
  const TriangleMesh target = scale_to_diameter(shape, 0.146);
  const Vec goal = flatten(target.vertices);
  RestShapeDesign design;
  design.membrane = std::make_shared<const Membrane>(target.triangles, target.vertex_count(), silicone,
                                                     Vec::Constant(target.triangle_count(), 3e-4));
  design.rest_positions0 = 0.5 * goal;
  const PressurizedMembrane sheet(*design.membrane, design.rest_positions0);
  SparseFactorization factorization;
  const Equilibrium inflated = inflate_to_volume(sheet, enclosed_volume(target), factorization);
  design.x0 = inflated.x;
  design.pressure = inflated.pressure;
  design.force_scale = inflated.pressure * surface_area(goal, target.triangles) / target.vertex_count();
  design.state_terms = {
      {1, std::make_shared<EdgeDihedralDistance>(target.triangles, goal, EdgeDihedralWeights{1, 0.03})}};
  design.design_terms = {{3e-3, std::make_shared<EdgeDihedralDistance>(target.triangles, design.rest_positions0,
                                                                       EdgeDihedralWeights{0, 1})}};
  return {.name = fmt::format("{}_{}", name, target.vertex_count()),
          .full = [design] { return full_space_program(design); },
          .reduced = [design] { return reduced_program(design); },
          .has_potential = true};
}

// The material of a clamped sheet, sought by its inflated shapes (4.9).
Instance clamped_sheet(const std::string& model, const std::vector<double>& start, const std::vector<ShapeStep>& steps)
{
  ShapeFit fit;
  fit.model = model;
  fit.start = start;
  fit.rings = 4;
  fit.steps = steps;
  return {.name = "sheet_" + model,
          .full = [fit] { return full_space_program(fit); },
          .reduced = [fit] { return reduced_program(fit); }};
}

std::vector<ShapeStep> sheet_steps(unsigned seed, const std::shared_ptr<const Material>& silicone)
{
  CampaignOptions campaign;
  campaign.thicknesses = {0.5e-3};
  campaign.samples = 1;
  campaign.volumes = {2e-5, 6e-5, 1e-4};
  campaign.rings = 12;
  campaign.seed = seed;
  return shape_steps(simulate_campaign(silicone, campaign), ShapeFit{}.radius, {.centres = 200});
}

// A model of rubber fitted to Treloar's three tests: least squares in the box that fits draw their starts from, begun
// at another part of each side, so that no two terms of a sum are the same.
Instance rubber_fit(const MaterialModel& model)
{
  const std::vector<RubberTest> tests{load_rubber_test("treloar_1944_uniaxial"),
                                      load_rubber_test("treloar_1944_pure_shear"),
                                      load_rubber_test("treloar_1944_sheet_inflation")};
  const auto fit = std::make_shared<const StressFit>(model, tests, Weights::Absolute, 2);
  const Vec lower = fit->lower_start(), upper = fit->upper_start();
  const Eigen::Index n = lower.size();
  const Vec share = Vec::LinSpaced(n, 1, double(n)) / double(n + 1);
  const Vec start = lower + share.cwiseProduct(upper - lower);
  Instance instance;
  instance.name = "rubber_" + model.name;
  instance.reduced = [fit, start, lower, upper] { return least_squares_program(fit, start, lower, upper); };
  return instance;
}

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

// All methods on all instances, and the table of outcomes.
class Comparison {
 public:
  explicit Comparison(Run& run) : run_(run) {}

  // Methods that do not come within 5 % of the best objective on one balloon are not tried on the next, larger one.
  void balloon(const Instance& instance)
  {
    const auto [outcomes, best] = compare(instance, 1e-6);
    for (const Outcome& outcome : outcomes)
      if (!std::isfinite(outcome.reached_s)) given_up_.insert(outcome.name());
    claims(run_, instance, outcomes, best);
  }
  void sheet(const Instance& instance)
  {
    const auto outcomes = compare(instance, 0).first;
    agreement(run_, instance, outcomes, {"augmented_lagrangian_gauss_newton_full", "reduced_gauss_newton_reduced"});
  }
  void rubber(const Instance& instance)
  {
    const auto outcomes = compare(instance, 0).first;
    agreement(run_, instance, outcomes, {"gradient_projection_reduced", "nlopt_lbfgs_reduced"});
  }

 private:
  std::pair<std::vector<Outcome>, double> compare(const Instance& instance, double relative_decrease)
  {
    const StopCriteria stop{.max_iterations = run_.by_size(25, 500), .relative_decrease = relative_decrease};
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

  Run& run_;
  std::set<std::string> given_up_;
  std::string table_ =
      "instance,formulation,method,termination,objective,infeasibility,stationarity,linear_solves,cpu [s],"
      "reached_linear_solves,reached_cpu [s],negative_eigenvalues,has_equilibrium,moved,resolved_objective\n";
};

void compare_all(Run& run)
{
  const std::shared_ptr<const Material> silicone = load_material("silicone");
  Comparison comparison(run);

  // 1. Balloons. A method may take 20 ms of CPU time a vertex, ten times what the fastest needs.
  if (!run.is_paper()) comparison.balloon(balloon("ellipsoid", ellipsoid(120), silicone));
  for (const int vertex_count : run.is_paper() ? std::vector{1000, 2000, 3265} : std::vector<int>{}) {
    Instance instance = balloon("bumpsphere", bumpsphere(1, vertex_count), silicone);
    instance.largest_cpu_s = 0.02 * vertex_count;
    comparison.balloon(instance);
  }
  // 2. The material of a clamped sheet.
  const std::vector<ShapeStep> steps = sheet_steps(run.seed(), silicone);
  comparison.sheet(clamped_sheet("hart_smith", {0.3e6, 0.01, 0.5}, steps));
  comparison.sheet(clamped_sheet("mooney_rivlin", {0.3e6, 0.05e6}, steps));
  // 3. Rubber.
  for (const MaterialModel& model : material_models()) comparison.rubber(rubber_fit(model));
}

}  // namespace

int main(int argc, char** argv)
{
  return softform::run_experiment(
      argc, argv,
      {"sec_3_2",
       "3.2",
       "On balloons the reduced Gauss-Newton method is first to come within 5 % of the best objective of all methods.",
       {1, 15}},
      compare_all);
}
