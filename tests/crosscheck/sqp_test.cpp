// Sequential quadratic programming on programmes with published optima and multipliers, and on broken ones.

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "softform/optimizers/sqp.hpp"
#include "support/small_program.hpp"
#include "support/test_programs.hpp"

namespace softform::testing {
namespace {

constexpr StopCriteria tight{.max_iterations = 500, .relative_decrease = 0};

Solution minimize(const NonlinearProgram& program, const SqpOptions& options = {})
{
  return Sqp(options).minimize(program, tight);
}

// HS 6, 7, 28 and 39, and Maratos'.
std::vector<PublishedProgram> equality_problems()
{
  std::vector<PublishedProgram> problems;
  for (const char* name : {"HS 6", "HS 7", "HS 28", "HS 39"}) problems.push_back(published_program(name));
  problems.push_back(maratos_program());
  return problems;
}

/// Another programme without its exact Hessian: the positive part of the objective's instead.
class WithoutExactHessian : public NonlinearProgram {
 public:
  explicit WithoutExactHessian(const NonlinearProgram& program) : program_(program) {}
  std::string name() const override { return program_.name(); }
  int variable_count() const override { return program_.variable_count(); }
  int constraint_count() const override { return program_.constraint_count(); }
  Vec initial_point() const override { return program_.initial_point(); }
  double objective(ConstVec z) const override { return program_.objective(z); }
  void objective_gradient(ConstVec z, Vec& g) const override { program_.objective_gradient(z, g); }
  void gauss_newton_hessian(ConstVec z, SparseMatrix& H) const override
  {
    program_.lagrangian_hessian(z, Vec::Zero(constraint_count()), H);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen{Eigen::MatrixXd(H)};
    const auto& V = eigen.eigenvectors();
    store(V * eigen.eigenvalues().cwiseMax(0).asDiagonal() * V.transpose(), H);
  }
  void constraints(ConstVec z, Vec& c) const override { program_.constraints(z, c); }
  void constraint_jacobian(ConstVec z, SparseMatrix& J) const override { program_.constraint_jacobian(z, J); }

 private:
  const NonlinearProgram& program_;
};

int iterations(const Solution& solution) { return solution.report.trace.back().k; }

void expect_optimum(const Solution& solution, const PublishedProgram& published, double tolerance)
{
  EXPECT_TRUE(solution.report.converged()) << solution.report.message;
  ASSERT_EQ(solution.z.size(), published.optimum.size());
  EXPECT_LT((solution.z - published.optimum).lpNorm<Eigen::Infinity>(), tolerance) << solution.z.transpose();
  ASSERT_EQ(solution.lagrange_multipliers.size(), published.lagrange_multipliers.size());
  EXPECT_LT((solution.lagrange_multipliers - published.lagrange_multipliers).lpNorm<Eigen::Infinity>(), tolerance)
      << solution.lagrange_multipliers.transpose();
}

TEST(Sqp, FindsPublishedOptima)
{
  for (const PublishedProgram& published : equality_problems()) {
    const auto& program = published.program;
    SCOPED_TRACE(program->name());
    const Solution solution = minimize(*program);
    expect_optimum(solution, published, 1e-6);
    EXPECT_LT(iterations(solution), 30);
    EXPECT_NE(solution.report.message.find("a minimum"), std::string::npos) << solution.report.message;
    EXPECT_LT(solution.bound_multipliers.lpNorm<Eigen::Infinity>(), 1e-6);
    EXPECT_NEAR(solution.objective, program->objective(published.optimum), 1e-8);
  }
}

// Where the curvature is the constraints', Gauss-Newton's Hessian knows nothing of it and convergence is linear; HS 39
// has no other curvature.
TEST(Sqp, ConvergesWithGaussNewtonHessians)
{
  for (const PublishedProgram& published : equality_problems()) {
    const auto& program = published.program;
    if (program->name() == "HS 39") continue;
    SCOPED_TRACE(program->name());
    expect_optimum(minimize(WithoutExactHessian(*program)), published, 1e-5);
  }
}

// Once the penalty exceeds the multiplier, the merit refuses full steps however close the optimum.
TEST(Sqp, SecondOrderCorrectionAvoidsTheMaratosEffect)
{
  const PublishedProgram maratos = maratos_program();
  const Solution with = minimize(*maratos.program, {.first_penalty = 10});
  const Solution without = minimize(*maratos.program, {.first_penalty = 10, .second_order_correction = false});
  RecordProperty("iterations_with", iterations(with));
  RecordProperty("iterations_without", iterations(without));
  expect_optimum(with, maratos, 1e-8);
  expect_optimum(without, maratos, 1e-6);
  EXPECT_LE(2 * iterations(with), iterations(without));
}

// A factorisation that is far from the KKT matrix, refined to a residual of a tenth only.
TEST(Sqp, ToleratesInexactSolves)
{
  for (const PublishedProgram& published : equality_problems()) {
    const auto& program = published.program;
    SCOPED_TRACE(program->name());
    const Solution solution = minimize(*program, {.linear_tolerance = 0.1, .constraint_regularization = 0.1});
    expect_optimum(solution, published, 1e-6);
    EXPECT_LT(iterations(solution), 30);
  }
}

TEST(Sqp, BacksOffWhereTheObjectiveIsNotFinite)
{
  const Solution solution = minimize(*logarithmic_program());
  EXPECT_TRUE(solution.report.converged()) << solution.report.message;
  EXPECT_NEAR(solution.z[0], 1, 1e-6);
}

TEST(Sqp, SaysWhatIsBroken)
{
  EXPECT_EQ(minimize(*undefined_program()).report.termination, Termination::NotFinite);
  for (const Solution& solution : {minimize(*parallel_lines_program()), minimize(*infeasible_program())}) {
    EXPECT_EQ(solution.report.termination, Termination::Infeasible) << solution.report.message;
    EXPECT_TRUE(solution.z.allFinite());
  }
  const Solution unbounded = minimize(*unbounded_on_a_line_program());
  EXPECT_FALSE(unbounded.report.converged());
  EXPECT_NE(unbounded.report.message.find("unbounded"), std::string::npos) << unbounded.report.message;
}

TEST(Sqp, RespectsItsLimits)
{
  const NonlinearProgram& program = *published_program("HS 7").program;
  EXPECT_EQ(Sqp().minimize(program, {.max_iterations = 2}).report.termination, Termination::IterationLimit);
  EXPECT_EQ(Sqp().minimize(program, {.max_time_s = -1}).report.termination, Termination::TimeLimit);
  const Solution interrupted = Sqp().minimize(program, {}, [](const Iterate& iterate) { return iterate.k < 3; });
  EXPECT_EQ(interrupted.report.termination, Termination::Interrupted);
  EXPECT_EQ(iterations(interrupted), 3);
}

}  // namespace
}  // namespace softform::testing
