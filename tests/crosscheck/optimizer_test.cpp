// The optimisers on a small programme whose optimum is known in closed form, and on ones that are broken.

#include <cmath>
#include <limits>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "softform/optimizers/augmented_lagrangian.hpp"
#include "softform/optimizers/feasible_newton.hpp"
#include "softform/optimizers/gradient_projection.hpp"
#include "softform/optimizers/least_squares_program.hpp"
#include "softform/optimizers/optimality.hpp"
#include "softform/optimizers/reduced_gauss_newton.hpp"
#include "support/deformations.hpp"

namespace softform::testing {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// A state s that follows a design d linearly: with z = (s, d),
//     min 1/2 |s - t|^2 + w/2 |d|^2   subject to   K s - B d = 0,
// so that d = (A^t A + w I)^-1 A^t t and s = A d, A = K^-1 B.
class LinearDesign : public NonlinearProgram {
 public:
  LinearDesign() : K_(n, n), B_(n, n), target_(wiggle(n, 3))
  {
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        K_(i, j) = i == j ? 3 : 1.0 / (1 + i + j);
        B_(i, j) = std::sin(1 + i + 2 * j);
      }
  }

  Vec optimum() const
  {
    const Eigen::MatrixXd A = K_.lu().solve(B_);
    Vec z(2 * n);
    z.tail(n) = (A.transpose() * A + weight * Eigen::MatrixXd::Identity(n, n)).llt().solve(A.transpose() * target_);
    z.head(n) = A * z.tail(n);
    return z;
  }

  std::string name() const override { return "linear design"; }
  int variable_count() const override { return 2 * n; }
  int constraint_count() const override { return n; }
  Vec initial_point() const override { return Vec::Ones(2 * n); }

  double objective(ConstVec z) const override
  {
    return 0.5 * (z.head(n) - target_).squaredNorm() + 0.5 * weight * z.tail(n).squaredNorm();
  }
  void objective_gradient(ConstVec z, Vec& g) const override
  {
    g.resize(2 * n);
    g << z.head(n) - target_, weight * z.tail(n);
  }
  void gauss_newton_hessian(ConstVec, SparseMatrix& H) const override
  {
    Eigen::MatrixXd dense = Eigen::MatrixXd::Identity(2 * n, 2 * n);
    dense.bottomRightCorner(n, n) *= weight;
    H = dense.sparseView();
  }
  void constraints(ConstVec z, Vec& c) const override { c = K_ * z.head(n) - B_ * z.tail(n); }
  void constraint_jacobian(ConstVec, SparseMatrix& J) const override
  {
    Eigen::MatrixXd dense(n, 2 * n);
    dense << K_, -B_;
    J = dense.sparseView();
  }
  std::optional<Vec> restore(ConstVec z) const override
  {
    if (!z.allFinite()) return std::nullopt;
    Vec restored = z;
    restored.head(n) = K_.lu().solve(B_ * z.tail(n));
    return restored;
  }

 protected:
  static constexpr int n = 5;
  static constexpr double weight = 0.5;

 private:
  Eigen::MatrixXd K_, B_;
  Vec target_;
};

Solution minimize_tightly(const NonlinearProgram& program, const ReducedGaussNewtonOptions& options)
{
  return ReducedGaussNewton(options).minimize(program,
                                              {.max_iterations = 200, .relative_decrease = 1e-15, .patience = 5});
}

TEST(ReducedGaussNewton, FindsTheOptimum)
{
  const LinearDesign program;
  const Solution solution = minimize_tightly(program, {.constraint_weight = 1e7});
  EXPECT_NE(solution.report.termination, Termination::IterationLimit) << solution.report.message;
  EXPECT_LT((solution.z - program.optimum()).cwiseAbs().maxCoeff(), 1e-8) << solution.report.message;
  EXPECT_NEAR(solution.objective, program.objective(program.optimum()), 1e-13);
}

// The weight of the linearised constraints is finite, which moves the design by its inverse and the objective by the
// square of that.
TEST(ReducedGaussNewton, DefaultsAreAccurateToTheConstraintWeight)
{
  const LinearDesign program;
  const Solution solution = minimize_tightly(program, {});
  EXPECT_LT((solution.z - program.optimum()).cwiseAbs().maxCoeff(), 1e-3) << solution.report.message;
  EXPECT_NEAR(solution.objective, program.objective(program.optimum()), 1e-6);
}

TEST(FeasibleNewton, FindsTheOptimum)
{
  const LinearDesign program;
  const Solution solution = FeasibleNewton().minimize(program, {.max_iterations = 100, .tolerance = 1e-10});
  EXPECT_TRUE(solution.report.converged()) << solution.report.message;
  EXPECT_LT((solution.z - program.optimum()).cwiseAbs().maxCoeff(), 1e-8);
}

// Every state in a double well, sum_i (s_i^2 - 1)^2 / 4, and no weight on the design.
class DoubleWells : public LinearDesign {
 public:
  Vec initial_point() const override { return 1e-3 * wiggle(2 * n, 2); }
  double objective(ConstVec z) const override { return (z.head(n).array().square() - 1).square().sum() / 4; }
  void objective_gradient(ConstVec z, Vec& g) const override
  {
    const Eigen::ArrayXd s = z.head(n);
    g = Vec::Zero(2 * n);
    g.head(n) = s * (s.square() - 1);
  }
  void gauss_newton_hessian(ConstVec z, SparseMatrix& H) const override
  {
    set_state_diagonal(2 * z.head(n).array().square(), H);
  }
  bool lagrangian_hessian(ConstVec z, ConstVec, SparseMatrix& H) const override
  {
    set_state_diagonal(3 * z.head(n).array().square() - 1, H);
    return true;
  }
  /// The smallest eigenvalue of the objective's second derivative in the design.
  double smallest_curvature(ConstVec z) const
  {
    SparseMatrix H, J;
    lagrangian_hessian(z, Vec::Zero(n), H);
    constraint_jacobian(z, J);
    const Eigen::MatrixXd A = -Eigen::MatrixXd(J.leftCols(n)).lu().solve(Eigen::MatrixXd(J.rightCols(n)));
    const Eigen::MatrixXd reduced = A.transpose() * Eigen::MatrixXd(H.topLeftCorner(n, n)) * A;
    return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(reduced).eigenvalues().minCoeff();
  }

 private:
  static void set_state_diagonal(const Eigen::ArrayXd& values, SparseMatrix& H)
  {
    Vec diagonal = Vec::Zero(2 * n);
    diagonal.head(n) = values;
    H = Eigen::MatrixXd(diagonal.asDiagonal()).sparseView();
  }
};

// It begins beside a maximum, where the exact Hessian is negative, and passes saddles; a Newton method that only takes
// convex models would have to fall back on Gauss-Newton's there, which was as good as stuck on a bear of 17 panels.
TEST(FeasibleNewton, LeavesSaddlesByTheirNegativeCurvature)
{
  const DoubleWells program;
  ASSERT_LT(program.smallest_curvature(*program.restore(program.initial_point())), -0.1);
  FeasibleNewtonOptions options;
  options.gauss_newton_decrease = HUGE_VAL;
  const Solution solution =
      FeasibleNewton(options).minimize(program, {.max_iterations = 100, .relative_decrease = 0, .tolerance = 1e-9});
  EXPECT_TRUE(solution.report.converged()) << solution.report.message;
  EXPECT_GT(program.smallest_curvature(solution.z), -1e-8);
}

// The same with some of the design in a box that its optimum lies outside of.
class BoxedDesign : public LinearDesign {
 public:
  Vec initial_point() const override { return Vec::Zero(2 * n); }
  Vec lower_bounds() const override
  {
    Vec lower = Vec::Constant(2 * n, -HUGE_VAL);
    lower.segment(n, 3).setConstant(-0.05);
    return lower;
  }
  Vec upper_bounds() const override
  {
    Vec upper = Vec::Constant(2 * n, HUGE_VAL);
    upper.tail(3).setConstant(0.05);
    return upper;
  }
};

TEST(ReducedGaussNewton, FindsTheOptimumWithinBounds)
{
  const BoxedDesign program;
  const Vec free = program.optimum();
  ASSERT_LT(std::min((free - program.lower_bounds()).minCoeff(), (program.upper_bounds() - free).minCoeff()), -0.05);
  const Solution solution = minimize_tightly(program, {.constraint_weight = 1e7});
  const Solution other = AugmentedLagrangian().minimize(program, {.relative_decrease = 0, .tolerance = 1e-9});
  ASSERT_TRUE(other.report.converged()) << other.report.message;
  EXPECT_LT((solution.z - other.z).lpNorm<Eigen::Infinity>(), 1e-6) << solution.report.message;
  EXPECT_GE((solution.z - program.lower_bounds()).minCoeff(), 0);
  EXPECT_GE((program.upper_bounds() - solution.z).minCoeff(), 0);
  EXPECT_LT(measure_optimality(program, solution.z).stationarity, 1e-5);
}

// min 1 + z^2 / 2, without constraints, with a Hessian that is `share` of the true one.
class ScaledHessian : public NonlinearProgram {
 public:
  explicit ScaledHessian(double share) : share_(share) {}
  std::string name() const override { return "scaled Hessian"; }
  int variable_count() const override { return 1; }
  int constraint_count() const override { return 0; }
  Vec initial_point() const override { return Vec::Ones(1); }
  double objective(ConstVec z) const override { return 1 + 0.5 * z.squaredNorm(); }
  void objective_gradient(ConstVec z, Vec& g) const override { g = z; }
  void gauss_newton_hessian(ConstVec, SparseMatrix& H) const override
  {
    H.resize(1, 1);
    H.setIdentity();
    H *= share_;
  }
  void constraints(ConstVec, Vec& c) const override { c.resize(0); }
  void constraint_jacobian(ConstVec, SparseMatrix& J) const override { J.resize(0, 1); }
  std::optional<Vec> restore(ConstVec z) const override { return Vec(z); }

 private:
  double share_;
};

// With the first damping a step is 1 / (0.3 + 0.1) times the way to the minimum: it fails, and half of it succeeds.
TEST(ReducedGaussNewton, HalvesAStepBeforeItFactorisesAgain)
{
  const Solution halved = ReducedGaussNewton().minimize(ScaledHessian(0.3), {.max_iterations = 1});
  EXPECT_EQ(halved.report.evaluations.linear_solve, 1);
  EXPECT_NEAR(halved.z[0], 1 - 0.5 / 0.4, 1e-9);
  const Solution damped = ReducedGaussNewton({.halvings = 0}).minimize(ScaledHessian(0.3), {.max_iterations = 1});
  EXPECT_EQ(damped.report.evaluations.linear_solve, 2);
  EXPECT_NEAR(damped.z[0], 1 - 1 / 0.7, 1e-9);
}

// A model that is exact promises nothing more after two steps; without its promise, two steps more would tell.
TEST(ReducedGaussNewton, EndsWhenTheModelPromisesNoMore)
{
  const StopCriteria stop{.max_iterations = 50, .relative_decrease = 0.02, .patience = 3};
  const Solution solution = ReducedGaussNewton().minimize(ScaledHessian(1), stop);
  EXPECT_TRUE(solution.report.converged());
  EXPECT_EQ(solution.report.trace.back().k, 2);
  EXPECT_LT(solution.objective - 1, 0.02 / 3);
}

// Exact where the penalty is finite: what the multipliers are for.
TEST(AugmentedLagrangian, FindsTheOptimum)
{
  const LinearDesign program;
  const Solution solution = AugmentedLagrangian().minimize(program, {.relative_decrease = 0, .tolerance = 1e-10});
  EXPECT_TRUE(solution.report.converged()) << solution.report.message;
  EXPECT_LT(solution.report.trace.back().infeasibility, 1e-10);
  EXPECT_LT((solution.z - program.optimum()).cwiseAbs().maxCoeff(), 1e-8) << solution.report.message;
  EXPECT_NEAR(solution.objective, program.objective(program.optimum()), 1e-10);
}

TEST(ReducedGaussNewton, RespectsItsLimits)
{
  const LinearDesign program;
  const Solution few = ReducedGaussNewton().minimize(program, {.max_iterations = 2, .relative_decrease = 0});
  EXPECT_EQ(few.report.termination, Termination::IterationLimit);
  EXPECT_EQ(few.report.trace.size(), 3U);
  const Solution short_time = ReducedGaussNewton().minimize(program, {.max_time_s = -1});
  EXPECT_EQ(short_time.report.termination, Termination::TimeLimit);
  EXPECT_TRUE(short_time.z.allFinite());
}

// What is broken: a function that returns NaN everywhere, or beyond the first point.
enum class Broken { Objective, ObjectiveElsewhere, Gradient, Hessian, Jacobian };

class BrokenDesign : public LinearDesign {
 public:
  explicit BrokenDesign(Broken broken) : broken_(broken) {}

  double objective(ConstVec z) const override
  {
    const bool is_first = (z - *restore(initial_point())).norm() == 0;
    const bool is_nan = broken_ == Broken::Objective || (broken_ == Broken::ObjectiveElsewhere && !is_first);
    return is_nan ? nan : LinearDesign::objective(z);
  }
  void objective_gradient(ConstVec z, Vec& g) const override
  {
    LinearDesign::objective_gradient(z, g);
    if (broken_ == Broken::Gradient) g[3] = nan;
  }
  void gauss_newton_hessian(ConstVec z, SparseMatrix& H) const override
  {
    LinearDesign::gauss_newton_hessian(z, H);
    if (broken_ == Broken::Hessian) H.coeffRef(2, 2) = nan;
  }
  void constraint_jacobian(ConstVec z, SparseMatrix& J) const override
  {
    LinearDesign::constraint_jacobian(z, J);
    if (broken_ == Broken::Jacobian) J.coeffRef(1, 1) = nan;
  }

 private:
  Broken broken_;
};

class OptimizersOnNan : public ::testing::TestWithParam<Broken> {};

TEST_P(OptimizersOnNan, ReducedGaussNewtonNeverSucceeds)
{
  const Solution solution = ReducedGaussNewton().minimize(BrokenDesign(GetParam()));
  EXPECT_FALSE(solution.report.converged()) << solution.report.message;
  EXPECT_TRUE(solution.z.allFinite());
  if (GetParam() != Broken::ObjectiveElsewhere) {
    EXPECT_EQ(solution.report.termination, Termination::NotFinite) << solution.report.message;
  }
}

INSTANTIATE_TEST_SUITE_P(Functions, OptimizersOnNan,
                         ::testing::Values(Broken::Objective, Broken::ObjectiveElsewhere, Broken::Gradient,
                                           Broken::Hessian, Broken::Jacobian));

// 1e12/2 (z - 3)^2 on [0, 5] from z = 1: the box is small beside the gradient.
class SteepInABox : public LeastSquaresProgram {
 public:
  std::string name() const override { return "steep in a box"; }
  int variable_count() const override { return 1; }
  int residual_count() const override { return 1; }
  Vec initial_point() const override { return Vec::Ones(1); }
  Vec lower_bounds() const override { return Vec::Zero(1); }
  Vec upper_bounds() const override { return Vec::Constant(1, 5); }
  void residuals(ConstVec z, Vec& r) const override { r = 1e6 * (z.array() - 3); }
  void residual_jacobian(ConstVec, SparseMatrix& R) const override
  {
    R.resize(1, 1);
    R.insert(0, 0) = 1e6;
    R.makeCompressed();
  }
};

TEST(Optimality, ABoxDoesNotHideALargeGradient)
{
  const SteepInABox program;
  EXPECT_NEAR(measure_optimality(program, program.initial_point()).stationarity, 1, 1e-12);
  const Solution solution = GradientProjection().minimize(program);
  EXPECT_TRUE(solution.report.converged()) << solution.report.message;
  EXPECT_NEAR(solution.z[0], 3, 1e-8);
}

// A programme that cannot be made feasible.
class Infeasible : public LinearDesign {
 public:
  std::optional<Vec> restore(ConstVec) const override { return std::nullopt; }
};

TEST(ReducedGaussNewton, InfeasibleStartIsReported)
{
  const Solution solution = ReducedGaussNewton().minimize(Infeasible());
  EXPECT_EQ(solution.report.termination, Termination::Infeasible);
  EXPECT_TRUE(solution.z.allFinite());
}

}  // namespace
}  // namespace softform::testing
