// The programmes that optimisers are tested on: derivatives by slopes, and optima by the first-order conditions.

#include <algorithm>

#include <gtest/gtest.h>

#include "support/deformations.hpp"
#include "support/finite_differences.hpp"
#include "support/test_programs.hpp"

namespace softform::testing {
namespace {

Vec number(double value) { return Vec::Constant(1, value); }

Vec lagrangian_gradient(const NonlinearProgram& program, const Vec& z, const Vec& lambda)
{
  Vec g;
  SparseMatrix J;
  program.objective_gradient(z, g);
  program.constraint_jacobian(z, J);
  return g + J.transpose() * lambda;
}

void check_derivatives(const NonlinearProgram& program, const Vec& z)
{
  SCOPED_TRACE(program.name());
  const Vec direction = wiggle(program.variable_count(), 3), lambda = wiggle(program.constraint_count(), 5);
  const Vec scaled = 0.1 * direction;
  Vec g;
  program.objective_gradient(z, g);
  EXPECT_SLOPE(check_slope([&](const Vec& y) { return number(program.objective(y)); }, z, scaled, number(g.dot(scaled)),
                           1e-1, 1e-3));
  const auto constraints = [&](const Vec& y) {
    Vec c;
    program.constraints(y, c);
    return c;
  };
  SparseMatrix J, H;
  program.constraint_jacobian(z, J);
  if (program.constraint_count() > 0) {
    EXPECT_SLOPE(check_slope(constraints, z, scaled, J * scaled, 1e-1, 1e-3));
  }
  ASSERT_TRUE(program.lagrangian_hessian(z, lambda, H));
  EXPECT_SLOPE(check_slope([&](const Vec& y) { return lagrangian_gradient(program, y, lambda); }, z, scaled, H * scaled,
                           1e-1, 1e-3));
}

TEST(PublishedPrograms, HaveExactDerivatives)
{
  for (const auto& [program, optimum, lambda, bound, is_degenerate] : published_programs())
    check_derivatives(*program, program->initial_point() + 0.1 * wiggle(program->variable_count(), 7));
}

TEST(ControlProgram, HasExactDerivatives)
{
  const auto program = control_program(5, ControlBounds::Active);
  check_derivatives(*program, wiggle(program->variable_count(), 7));
}

// f' + J^t lambda = bound multipliers of the right signs, c = 0, within the bounds.
TEST(PublishedPrograms, HaveOptimaThatSatisfyTheFirstOrderConditions)
{
  for (const auto& [program, optimum, lambda, bound, is_degenerate] : published_programs()) {
    SCOPED_TRACE(program->name());
    Vec c;
    program->constraints(optimum, c);
    if (c.size() > 0) {
      EXPECT_LT(c.cwiseAbs().maxCoeff(), 1e-10);
    }
    for (int i = 0; i < program->variable_count(); ++i) {
      const double lower = program->lower_bounds()[i], upper = program->upper_bounds()[i];
      EXPECT_TRUE(lower <= optimum[i] && optimum[i] <= upper);
      EXPECT_TRUE(bound[i] <= 0 || optimum[i] == lower);
      EXPECT_TRUE(bound[i] >= 0 || optimum[i] == upper);
    }
    // Without multipliers there is nothing more to check than that a neighbour is not better; see the conformance test.
    if (lambda.size() != c.size()) continue;
    EXPECT_LT((lagrangian_gradient(*program, optimum, lambda) - bound).cwiseAbs().maxCoeff(), 1e-9);
  }
}

}  // namespace
}  // namespace softform::testing
