// Sequential quadratic programming on programmes with published optima and multipliers, and on broken ones.

#include <gtest/gtest.h>

#include "softform/core/error.hpp"
#include "softform/optimizers/sqp.hpp"
#include "support/small_programs.hpp"

namespace softform::testing {
namespace {

constexpr StopCriteria tight{.max_iterations = 500, .relative_decrease = 0};

Solution minimize(const NonlinearProgram& program, const SqpOptions& options = {})
{
  return Sqp(options).minimize(program, tight);
}

template <class M>
Solution minimize(const SqpOptions& options = {})
{
  return minimize(AutoProgram<M>(), options);
}

int iterations(const Solution& solution) { return solution.report.trace.back().k; }

void expect_optimum(const Solution& solution, const Optimum& optimum, double tolerance)
{
  EXPECT_TRUE(solution.report.converged()) << solution.report.message;
  ASSERT_EQ(solution.z.size(), optimum.z.size());
  EXPECT_LT((solution.z - optimum.z).lpNorm<Eigen::Infinity>(), tolerance) << solution.z.transpose();
  ASSERT_EQ(solution.lagrange_multipliers.size(), optimum.lambda.size());
  EXPECT_LT((solution.lagrange_multipliers - optimum.lambda).lpNorm<Eigen::Infinity>(), tolerance)
      << solution.lagrange_multipliers.transpose();
}

TEST(Sqp, FindsPublishedOptima)
{
  for (const auto& [program, optimum] : equality_problems()) {
    SCOPED_TRACE(program->name());
    const Solution solution = minimize(*program);
    expect_optimum(solution, optimum, 1e-6);
    EXPECT_LT(iterations(solution), 30);
    EXPECT_NE(solution.report.message.find("a minimum"), std::string::npos) << solution.report.message;
    EXPECT_LT(solution.bound_multipliers.lpNorm<Eigen::Infinity>(), 1e-6);
    EXPECT_NEAR(solution.objective, program->objective(optimum.z), 1e-8);
  }
}

// Where the curvature is the constraints', Gauss-Newton's Hessian knows nothing of it and convergence is linear; HS 39
// has no other curvature.
TEST(Sqp, ConvergesWithGaussNewtonHessians)
{
  for (const auto& [program, optimum] : equality_problems()) {
    if (program->name() == "hs39") continue;
    SCOPED_TRACE(program->name());
    expect_optimum(minimize(WithoutExactHessian(*program)), optimum, 1e-5);
  }
}

// Once the penalty exceeds the multiplier, the merit refuses full steps however close the optimum.
TEST(Sqp, SecondOrderCorrectionAvoidsTheMaratosEffect)
{
  const Solution with = minimize<Maratos>({.first_penalty = 10});
  const Solution without = minimize<Maratos>({.first_penalty = 10, .second_order_correction = false});
  RecordProperty("iterations_with", iterations(with));
  RecordProperty("iterations_without", iterations(without));
  expect_optimum(with, {vec({1, 0}), vec({-1.5})}, 1e-8);
  expect_optimum(without, {vec({1, 0}), vec({-1.5})}, 1e-6);
  EXPECT_LE(2 * iterations(with), iterations(without));
}

// A factorisation that is far from the KKT matrix, refined to a residual of a tenth only.
TEST(Sqp, ToleratesInexactSolves)
{
  for (const auto& [program, optimum] : equality_problems()) {
    SCOPED_TRACE(program->name());
    const Solution solution = minimize(*program, {.linear_tolerance = 0.1, .constraint_regularization = 0.1});
    expect_optimum(solution, optimum, 1e-6);
    EXPECT_LT(iterations(solution), 30);
  }
}

TEST(Sqp, CopesWithDependentConstraints)
{
  const Solution solution = minimize<Degenerate>();
  ASSERT_TRUE(solution.report.converged()) << solution.report.message;
  EXPECT_LT((solution.z - vec({0, std::sqrt(3)})).norm(), 1e-6);
  EXPECT_NEAR(solution.lagrange_multipliers.dot(vec({1, 2})), 0.5 / std::sqrt(3), 1e-6);
}

TEST(Sqp, BacksOffWhereTheObjectiveIsNotFinite) { expect_optimum(minimize<LogBarrier>(), {vec({1}), Vec(0)}, 1e-6); }

TEST(Sqp, SaysWhatIsBroken)
{
  EXPECT_EQ(minimize<NotFiniteAtStart>().report.termination, Termination::NotFinite);
  for (const Solution& solution : {minimize<Infeasible>(), minimize<InfeasibleCurve>()}) {
    EXPECT_EQ(solution.report.termination, Termination::Infeasible) << solution.report.message;
    EXPECT_TRUE(solution.z.allFinite());
  }
  const Solution unbounded = minimize<UnboundedBelow>();
  EXPECT_FALSE(unbounded.report.converged());
  EXPECT_NE(unbounded.report.message.find("unbounded"), std::string::npos) << unbounded.report.message;
}

TEST(Sqp, RespectsItsLimits)
{
  const AutoProgram<Hs7> program;
  EXPECT_EQ(Sqp().minimize(program, {.max_iterations = 2}).report.termination, Termination::IterationLimit);
  EXPECT_EQ(Sqp().minimize(program, {.max_time_s = -1}).report.termination, Termination::TimeLimit);
  const Solution interrupted = Sqp().minimize(program, {}, [](const Iterate& iterate) { return iterate.k < 3; });
  EXPECT_EQ(interrupted.report.termination, Termination::Interrupted);
  EXPECT_EQ(iterations(interrupted), 3);
}

TEST(Sqp, RefusesBounds) { EXPECT_THROW(minimize(Rosenbrock(0.5)), InputError); }

}  // namespace
}  // namespace softform::testing
