// The examples of CONTRIBUTING.md do what it says.

#include <gtest/gtest.h>

#include "../docs/examples/my_optimizer.hpp"
#include "../docs/examples/my_problem.hpp"
#include "softform/optimizers/registry.hpp"
#include "support/small_program.hpp"
#include "support/test_programs.hpp"

namespace softform::testing {
namespace {

constexpr StopCriteria tight{.max_iterations = 500, .relative_decrease = 0};

// The multiplier from z (1 + 2 lambda) = t with |z| = 1.
TEST(Examples, MyProblemIsSolvedByEveryMethodForConstraints)
{
  const Vec t = vec({2, 3, 6});
  const ClosestPoint program(t);
  int methods = 0;
  for (const OptimizerEntry& entry : optimizers()) {
    if (!entry.takes_constraints || entry.needs_restoration || entry.name == "quadratic_penalty") continue;
    SCOPED_TRACE(entry.name);
    const Solution solution = entry.make()->minimize(program, tight);
    EXPECT_TRUE(solution.report.converged()) << solution.report.message;
    EXPECT_LT((solution.z - t / 7).norm(), 1e-6);
    ASSERT_EQ(solution.lagrange_multipliers.size(), 1);
    EXPECT_NEAR(solution.lagrange_multipliers[0], 3, 1e-5);
    ++methods;
  }
  EXPECT_GE(methods, 4);
}

TEST(Examples, MyOptimizerConvergesAndReports)
{
  const auto barrier = logarithmic_program();
  const NonlinearProgram& program = *barrier;
  const Solution solution = SteepestDescent().minimize(program, tight);
  EXPECT_TRUE(solution.report.converged()) << solution.report.message;
  EXPECT_NEAR(solution.z[0], 1, 1e-7);
  EXPECT_EQ(SteepestDescent().minimize(*undefined_program()).report.termination, Termination::NotFinite);
  EXPECT_EQ(SteepestDescent().minimize(program, {.max_iterations = 1}).report.termination, Termination::IterationLimit);
}

}  // namespace
}  // namespace softform::testing
