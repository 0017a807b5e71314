// A fit as a nonlinear programme: its derivatives, and that optimisers find what the fit's own solver finds.

#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "softform/fitting/least_squares_as_program.hpp"
#include "softform/fitting/parameter_fit.hpp"
#include "softform/materials/registry.hpp"
#include "softform/optimizers/registry.hpp"
#include "support/deformations.hpp"
#include "support/finite_differences.hpp"

namespace softform::testing {
namespace {

std::shared_ptr<const StressFit> hart_smith_fit()
{
  const std::vector<RubberTest> tests{load_rubber_test("treloar_1944_uniaxial"),
                                      load_rubber_test("treloar_1944_sheet_inflation")};
  return std::make_shared<const StressFit>(find_material_model("hart_smith"), tests, Weights::Absolute, 1);
}

std::unique_ptr<LeastSquaresProgram> program_of(const std::shared_ptr<const StressFit>& fit)
{
  const Vec start = 0.5 * (fit->lower_start() + fit->upper_start());
  return least_squares_program(fit, start, fit->lower_start(), fit->upper_start());
}

TEST(LeastSquaresAsProgram, DerivativesAreThoseOfTheFit)
{
  const auto program = program_of(hart_smith_fit());
  const Vec z{{-1.5, -7, -1}}, direction{{1, -0.5, 0.7}};
  SparseMatrix R;
  program->residual_jacobian(z, R);
  const auto residuals = [&](const Vec& y) {
    Vec r;
    program->residuals(y, r);
    return r;
  };
  EXPECT_SLOPE(check_slope(residuals, z, direction, R * direction, 1e-2));
}

TEST(LeastSquaresAsProgram, OptimizersFindTheMinimumOfTheFitsOwnSolver)
{
  const auto fit = hart_smith_fit();
  const auto program = program_of(fit);
  const LeastSquaresSolution own = minimize_by_gauss_newton(*fit, Vec{{-1.5, -7, -1}}, {});
  ASSERT_TRUE(own.report.converged()) << own.report.message;
  ASSERT_TRUE((own.z.array() > fit->lower_start().array()).all() && (own.z.array() < fit->upper_start().array()).all());
  for (const char* method : {"gradient_projection", "nlopt_lbfgs"}) {
    const Solution found = make_optimizer(method)->minimize(*program, {.max_iterations = 500, .relative_decrease = 0});
    EXPECT_NEAR(found.objective / own.cost, 1, 1e-6) << method << ": " << found.report.message;
  }
}

// exp overflows: solvers step there and come back.
TEST(LeastSquaresAsProgram, WithoutValuesItIsNotFinite)
{
  const auto program = program_of(hart_smith_fit());
  const Vec z{{800, 0, 0}};
  EXPECT_FALSE(std::isfinite(program->objective(z)));
  SparseMatrix R;
  program->residual_jacobian(z, R);
  EXPECT_EQ(R.nonZeros(), static_cast<Eigen::Index>(R.rows()) * R.cols());
  EXPECT_FALSE(R.coeffs().isFinite().any());
}

}  // namespace
}  // namespace softform::testing
