// Every method of the registry on every programme that it can take: published optima and multipliers, bounds, the trace,
// the observer; and programmes without an optimum, where the report has to say so.

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "softform/optimizers/registry.hpp"
#include "support/deformations.hpp"
#include "support/finite_differences.hpp"
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
  return (entry.takes_constraints || program.constraint_count() == 0) &&
         (entry.takes_bounds || !has_bounds(program)) &&
         (!entry.needs_restoration || program.restore(program.initial_point()));
}

// How tight a method can be asked to be. The quadratic penalty leaves constraints of lambda / mu, and round-off in its
// gradient grows with mu.
StopCriteria stop_criteria(const std::string& method)
{
  StopCriteria stop = tight;
  if (method == "quadratic_penalty") stop.tolerance = 1e-6;
  return stop;
}

// What that is worth in the result.
double accuracy(const std::string& method) { return method == "quadratic_penalty" ? 2e-5 : 1e-6; }

struct Case {
  std::string method;
  PublishedProgram published;
};

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

// Where a method ends elsewhere for a reason that lies in its mathematics.
const std::map<std::pair<std::string, std::string>, std::string> known_failures{
};

void expect_near(const Vec& found, const Vec& expected, double tolerance, const char* what)
{
  ASSERT_EQ(found.size(), expected.size()) << what;
  for (Eigen::Index i = 0; i < found.size(); ++i)
    EXPECT_NEAR(found[i], expected[i], tolerance * std::max(1.0, std::abs(expected[i]))) << what << " " << i;
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
    EXPECT_GT(trace[k].k, trace[k - 1].k);
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
  const Solution solution = make_optimizer(method)->minimize(program, stop_criteria(method));
  const double digits = accuracy(method), at_optimum = program.objective(published.optimum);
  expect_within_bounds(program, solution.z);
  expect_consistent_trace(program, solution);
  EXPECT_TRUE(solution.report.converged()) << to_string(solution.report.termination) << solution.report.message;
  EXPECT_NEAR(solution.objective, at_optimum, digits * std::max(1.0, std::abs(at_optimum)));
  expect_near(solution.z, published.optimum, published.is_degenerate ? 0.05 : digits, "z");
  if (published.lagrange_multipliers.size() > 0 && solution.lagrange_multipliers.size() > 0)
    expect_near(solution.lagrange_multipliers, published.lagrange_multipliers, digits, "lambda");
  if (solution.bound_multipliers.size() > 0)
    expect_near(solution.bound_multipliers, published.bound_multipliers, digits, "bound multiplier");
  printf("%-34s %-24s its %d solves %d %s\n", method.c_str(), program.name().c_str(), (int)solution.report.trace.size() - 1,
         solution.report.evaluations.linear_solve, solution.report.message.c_str());
}

INSTANTIATE_TEST_SUITE_P(Optimizers, Conformance, ::testing::ValuesIn(cases()), [](const auto& test) {
  return identifier(test.param.method) + "_" + identifier(test.param.published.program->name());
});

}  // namespace
}  // namespace softform::testing
