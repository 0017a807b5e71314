// Every method of the registry on every programme that it can take: published optima and multipliers, bounds, the
// trace, the observer; and programmes without an optimum, where the report has to say so.

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>

#include <Eigen/SparseLU>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "softform/core/error.hpp"
#include "softform/optimizers/least_squares_program.hpp"
#include "softform/optimizers/registry.hpp"
#include "support/test_programs.hpp"

namespace softform::testing {
namespace {

// First-order optimality alone decides: slow progress is none.
const StopCriteria tight{.max_iterations = 3000, .max_time_s = 60, .relative_decrease = 0, .tolerance = 1e-8};

bool has_bounds(const NonlinearProgram& program)
{
  return program.lower_bounds().maxCoeff() > -HUGE_VAL || program.upper_bounds().minCoeff() < HUGE_VAL;
}

bool takes(const OptimizerEntry& entry, const NonlinearProgram& program)
{
  return (entry.takes_constraints || program.constraint_count() == 0) && (entry.takes_bounds || !has_bounds(program)) &&
         (!entry.needs_residuals || dynamic_cast<const LeastSquaresProgram*>(&program) != nullptr) &&
         (!entry.needs_restoration || program.restore(program.initial_point()));
}

// How tight a method can be asked to be, which is the accuracy of its result. The quadratic penalty leaves constraints
// of lambda / mu, and the round-off in its gradient grows with mu. The reduced Gauss-Newton method looks at the
// objective alone: it is accurate to the inverse of its constraint weight, and stalls there. NLopt stops on changes of
// the variables and the objective, not on first-order conditions.
struct Demand {
  StopCriteria stop = tight;
  double accuracy = 1e-6;
  bool may_stall = false;
};

Demand demand(const std::string& method, const NonlinearProgram& program)
{
  Demand demand;
  if (method == "quadratic_penalty" && program.constraint_count() > 0) {
    demand.stop.tolerance = 1e-6;
    demand.accuracy = 2e-5;
  } else if (method == "reduced_gauss_newton") {
    demand.stop.tolerance = 2e-3;
    demand.accuracy = 2e-3;
    demand.may_stall = true;
  } else if (method.starts_with("nlopt_")) {
    demand.accuracy = 1e-5;
    demand.may_stall = true;
  }
  return demand;
}

// Where a method fails for a reason that lies in its mathematics.
const std::map<std::pair<std::string, std::string>, std::string> known_failures{
    {{"nlopt_slsqp", "dependent constraints"}, "its subproblem needs independent constraint gradients"},
};

struct Case {
  std::string method;
  PublishedProgram published;
};

std::ostream& operator<<(std::ostream& stream, const Case& test)
{
  return stream << test.method << " on " << test.published.program->name();
}

std::vector<Case> cases()
{
  std::vector<Case> all;
  for (const OptimizerEntry& entry : optimizers())
    for (const PublishedProgram& published : published_programs())
      if (takes(entry, *published.program)) all.push_back({entry.name, published});
  return all;
}

std::string identifier(const std::string& text)
{
  std::string name;
  for (const char c : text)
    if (std::isalnum(static_cast<unsigned char>(c))) name += c;
  return name;
}

std::string describe(const Solution& solution)
{
  return fmt::format("{}: {}", to_string(solution.report.termination), solution.report.message);
}

void expect_near(const Vec& found, const Vec& expected, double tolerance, const char* what)
{
  ASSERT_EQ(found.size(), expected.size()) << what;
  for (Eigen::Index i = 0; i < found.size(); ++i)
    EXPECT_NEAR(found[i], expected[i], tolerance * std::max(1.0, std::abs(expected[i]))) << what << " " << i;
}

void expect_converged(const Solution& solution, bool may_stall)
{
  EXPECT_TRUE(solution.report.converged() || (may_stall && solution.report.termination == Termination::Stalled));
}

void expect_within_bounds(const NonlinearProgram& program, const Vec& z)
{
  const double rounding = 1e-8;
  EXPECT_GE((z - program.lower_bounds()).minCoeff(), -rounding);
  EXPECT_LE((z - program.upper_bounds()).maxCoeff(), rounding);
}

// The last line is the result, and the lines are in order.
void expect_consistent_trace(const NonlinearProgram& program, const Solution& solution)
{
  const auto& trace = solution.report.trace;
  ASSERT_FALSE(trace.empty());
  EXPECT_EQ(trace.back().objective, solution.objective);
  EXPECT_EQ(program.objective(solution.z), solution.objective);
  Vec c;
  program.constraints(solution.z, c);
  if (c.size() > 0) {
    EXPECT_NEAR(trace.back().infeasibility, c.cwiseAbs().maxCoeff(), 1e-12);
  }
  for (std::size_t k = 1; k < trace.size(); ++k) {
    EXPECT_GE(trace[k].k, trace[k - 1].k);
    EXPECT_GE(trace[k].elapsed_s, trace[k - 1].elapsed_s);
  }
  EXPECT_GT(solution.report.evaluations.value, 0);
  EXPECT_GT(solution.report.evaluations.gradient, 0);
}

class Conformance : public ::testing::TestWithParam<Case> {};

TEST_P(Conformance, FindsThePublishedOptimum)
{
  const auto& [method, published] = GetParam();
  const NonlinearProgram& program = *published.program;
  const auto [stop, accuracy, may_stall] = demand(method, program);
  const Solution solution = make_optimizer(method)->minimize(program, stop);
  SCOPED_TRACE(describe(solution));
  if (const auto reason = known_failures.find({method, program.name()}); reason != known_failures.end()) {
    EXPECT_FALSE(solution.report.converged()) << "no longer fails: " << reason->second;
    return;
  }
  expect_converged(solution, may_stall);
  expect_within_bounds(program, solution.z);
  expect_consistent_trace(program, solution);
  const double at_optimum = program.objective(published.optimum);
  EXPECT_NEAR(solution.objective, at_optimum, accuracy * std::max(1.0, std::abs(at_optimum)));
  expect_near(solution.z, published.optimum, published.is_degenerate ? 0.05 : accuracy, "z");
  if (published.lagrange_multipliers.size() > 0 && solution.lagrange_multipliers.size() > 0)
    expect_near(solution.lagrange_multipliers, published.lagrange_multipliers, accuracy, "lambda");
  if (solution.bound_multipliers.size() > 0)
    expect_near(solution.bound_multipliers, published.bound_multipliers, accuracy, "bound multiplier");
}

TEST_P(Conformance, TheObserverInterrupts)
{
  const auto& [method, published] = GetParam();
  const Solution solution = make_optimizer(method)->minimize(
      *published.program, demand(method, *published.program).stop, [](const Iterate&) { return false; });
  SCOPED_TRACE(describe(solution));
  EXPECT_EQ(solution.report.termination, Termination::Interrupted);
  EXPECT_TRUE(solution.z.allFinite());
}

INSTANTIATE_TEST_SUITE_P(Optimizers, Conformance, ::testing::ValuesIn(cases()), [](const auto& test) {
  return identifier(test.param.method) + "_" + identifier(test.param.published.program->name());
});

// Our methods of section 3.2 on every programme with one optimum, against what IPOPT finds there.
std::vector<Case> cases_against_ipopt()
{
  const auto is_ipopt = [](const OptimizerEntry& entry) { return entry.name == "ipopt"; };
  std::vector<Case> chosen;
  if (std::none_of(optimizers().begin(), optimizers().end(), is_ipopt)) return chosen;
  for (const Case& test : cases()) {
    const bool is_ours =
        test.method == "augmented_lagrangian" || test.method == "sqp" || test.method == "gradient_projection";
    if (is_ours && !test.published.is_degenerate) chosen.push_back(test);
  }
  return chosen;
}

class AgainstIpopt : public ::testing::TestWithParam<Case> {};

TEST_P(AgainstIpopt, OptimumAndMultipliersAgree)
{
  const auto& [method, published] = GetParam();
  const Solution ours = make_optimizer(method)->minimize(*published.program, tight);
  const Solution theirs = make_optimizer("ipopt")->minimize(*published.program, tight);
  SCOPED_TRACE(describe(ours) + " / " + describe(theirs));
  constexpr double accuracy = 1e-6;
  EXPECT_NEAR(ours.objective, theirs.objective, accuracy * std::max(1.0, std::abs(theirs.objective)));
  expect_near(ours.z, theirs.z, accuracy, "z");
  if (published.lagrange_multipliers.size() > 0)
    expect_near(ours.lagrange_multipliers, theirs.lagrange_multipliers, accuracy, "lambda");
  expect_near(ours.bound_multipliers, theirs.bound_multipliers, accuracy, "bound multiplier");
}

INSTANTIATE_TEST_SUITE_P(Optimizers, AgainstIpopt, ::testing::ValuesIn(cases_against_ipopt()), [](const auto& test) {
  return identifier(test.param.method) + "_" + identifier(test.param.published.program->name());
});

std::vector<OptimizerEntry> methods_for(const NonlinearProgram& program)
{
  std::vector<OptimizerEntry> all;
  for (const OptimizerEntry& entry : optimizers())
    if (takes(entry, program)) all.push_back(entry);
  return all;
}

// Programmes without an optimum, each for the methods that take it.
class Broken : public ::testing::TestWithParam<OptimizerEntry> {
 protected:
  // NLopt's SLSQP goes on for ever where there is no feasible point: its time limit is what ends it.
  Solution minimize(const NonlinearProgram& program) const
  {
    StopCriteria stop = tight;
    stop.max_time_s = 5;
    return GetParam().make()->minimize(program, stop);
  }
};
class Infeasible : public Broken {};
class Unbounded : public Broken {};
class Undefined : public Broken {};
class Irregular : public Broken {};

TEST_P(Infeasible, IsSaid)
{
  const Solution solution = minimize(*infeasible_program());
  EXPECT_EQ(solution.report.termination, Termination::Infeasible) << describe(solution);
  EXPECT_TRUE(solution.z.allFinite());
  // Where the constraint is smallest, nearly: that is what can be had.
  EXPECT_LT(solution.z.norm(), 1e-3) << describe(solution);
}

TEST_P(Unbounded, IsSaid)
{
  const Solution solution = minimize(*unbounded_program());
  EXPECT_FALSE(solution.report.converged()) << describe(solution);
  EXPECT_LT(solution.objective, -1e3) << describe(solution);
}

TEST_P(Undefined, IsSaid)
{
  const Solution solution = minimize(*undefined_program());
  EXPECT_EQ(solution.report.termination, Termination::NotFinite) << describe(solution);
}

// The optimum z = 0 of min z s.t. z^2 = 0 has no multiplier: f' + lambda c' = 1 there. Near it, |c| is below any
// tolerance with a multiplier that is large enough, so that a method may converge; it must not be far away.
TEST_P(Irregular, IsApproached)
{
  const Solution solution = minimize(*irregular_program());
  EXPECT_TRUE(solution.z.allFinite());
  EXPECT_LT(solution.z.norm(), 1e-2) << describe(solution);
}

std::string method_name(const ::testing::TestParamInfo<OptimizerEntry>& test) { return identifier(test.param.name); }

INSTANTIATE_TEST_SUITE_P(Optimizers, Infeasible, ::testing::ValuesIn(methods_for(*infeasible_program())), method_name);
INSTANTIATE_TEST_SUITE_P(Optimizers, Unbounded, ::testing::ValuesIn(methods_for(*unbounded_program())), method_name);
INSTANTIATE_TEST_SUITE_P(Optimizers, Undefined, ::testing::ValuesIn(methods_for(*undefined_program())), method_name);
INSTANTIATE_TEST_SUITE_P(Optimizers, Irregular, ::testing::ValuesIn(methods_for(*irregular_program())), method_name);

// 800 sparse variables, with and without active bounds: the first-order conditions, evaluated here.
constexpr int control_grid = 20;
using ControlCase = std::tuple<OptimizerEntry, ControlBounds>;
class Control : public ::testing::TestWithParam<ControlCase> {};

std::vector<ControlCase> control_cases()
{
  std::vector<ControlCase> all;
  for (const ControlBounds bounds : {ControlBounds::None, ControlBounds::Active})
    for (const OptimizerEntry& entry : methods_for(*control_program(control_grid, bounds)))
      if (entry.name != "nlopt_slsqp") all.emplace_back(entry, bounds);  // dense: 800 variables take it minutes
  return all;
}

TEST_P(Control, EndsAtAFirstOrderPoint)
{
  const auto& [entry, bounds] = GetParam();
  const auto program = control_program(control_grid, bounds);
  const auto [stop, accuracy, may_stall] = demand(entry.name, *program);
  const Solution solution = entry.make()->minimize(*program, stop);
  SCOPED_TRACE(describe(solution));
  expect_converged(solution, may_stall);
  expect_within_bounds(*program, solution.z);
  expect_consistent_trace(*program, solution);
  Vec c, g;
  SparseMatrix J;
  program->constraints(solution.z, c);
  program->objective_gradient(solution.z, g);
  program->constraint_jacobian(solution.z, J);
  EXPECT_LE(c.cwiseAbs().maxCoeff(), stop.tolerance);
  Vec lambda = solution.lagrange_multipliers;
  if (lambda.size() == 0)
    lambda = Eigen::SparseLU<SparseMatrix>(J.leftCols(c.size()).transpose()).solve(-g.head(c.size()));  // adjoint
  ASSERT_EQ(lambda.size(), c.size());
  g += J.transpose() * lambda;
  int active = 0;
  for (int i = 0; i < program->variable_count(); ++i) {
    // Interior points end just inside the bounds.
    const bool is_lower = solution.z[i] <= program->lower_bounds()[i] + accuracy;
    const bool is_upper = solution.z[i] >= program->upper_bounds()[i] - accuracy;
    active += is_lower || is_upper;
    EXPECT_GT(g[i], is_upper ? -HUGE_VAL : -accuracy) << i;
    EXPECT_LT(g[i], is_lower ? HUGE_VAL : accuracy) << i;
  }
  EXPECT_EQ(active > 20, bounds == ControlBounds::Active) << active;
}

std::string control_name(const ::testing::TestParamInfo<ControlCase>& test)
{
  const auto& [entry, bounds] = test.param;
  return identifier(entry.name) + (bounds == ControlBounds::Active ? "_bounds" : "");
}

INSTANTIATE_TEST_SUITE_P(Optimizers, Control, ::testing::ValuesIn(control_cases()), control_name);

// A method that cannot take a programme refuses it before any work.
TEST(Optimizers, RefuseWhatTheyDoNotTake)
{
  for (const OptimizerEntry& entry : optimizers())
    for (const PublishedProgram& published : published_programs())
      if (!takes(entry, *published.program) && !entry.needs_restoration) {
        EXPECT_THROW(entry.make()->minimize(*published.program, tight), InputError)
            << entry.name << " on " << published.program->name();
      }
}

}  // namespace
}  // namespace softform::testing
