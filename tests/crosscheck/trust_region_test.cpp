// Steps in a trust region on a small model, against dense algebra on the null space of its constraints.

#include <cmath>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "softform/optimizers/trust_region.hpp"
#include "support/deformations.hpp"

namespace softform::testing {
namespace {

constexpr int n = 12, m = 4;

// A positive definite matrix with eigenvalues from 1 to some tens.
Eigen::MatrixXd definite(int seed)
{
  Eigen::MatrixXd A(n, n);
  for (int j = 0; j < n; ++j) A.col(j) = wiggle(n, seed + j);
  return A * A.transpose() + Eigen::MatrixXd::Identity(n, n);
}

class SmallModel : public ::testing::Test {
 protected:
  SmallModel()
  {
    for (int i = 0; i < m; ++i) J.row(i) = wiggle(n, 20 + i);
    Z = J.fullPivLu().kernel();
    EXPECT_TRUE(metric.factorize(M.sparseView(), J.sparseView()));
    EXPECT_TRUE(metric.is_convex());
  }

  double decrease(const Eigen::MatrixXd& H, const Vec& d) const { return -(g.dot(d) + 0.5 * d.dot(H * d)); }

  void expect_step_of_the_model(const Eigen::MatrixXd& H, const TrustRegionStep& step, double radius) const
  {
    EXPECT_LT((J * step.d).norm(), 1e-8 * step.d.norm());
    EXPECT_NEAR(step.norm, std::sqrt(step.d.dot(M * step.d)), 1e-6 * step.norm);
    EXPECT_LE(step.norm, radius * (1 + 1e-12));
    EXPECT_NEAR(step.predicted_decrease, decrease(H, step.d), 1e-12 * decrease(H, step.d));
    EXPECT_EQ(step.is_on_boundary, step.norm == radius);
  }

  Eigen::MatrixXd M = definite(1), J{m, n}, Z, none{n, 0};
  Vec g = wiggle(n, 40);
  KktSystem metric;
};

TEST_F(SmallModel, ADensePartOfTheHessianIsInTheModel)
{
  Eigen::MatrixXd U(n, 2);
  U << 3 * wiggle(n, 60), 2 * wiggle(n, 61);
  const Eigen::MatrixXd H = definite(7);
  const SparseMatrix sparse = H.sparseView();
  const TrustRegionStep step = TrustRegionModel(metric, sparse, U, g).step(1e6);
  const Eigen::MatrixXd whole = H + U * U.transpose();
  expect_step_of_the_model(whole, step, 1e6);
  const Vec best = -Z * (Z.transpose() * whole * Z).ldlt().solve(Z.transpose() * g);
  EXPECT_GT(step.predicted_decrease, 0.98 * decrease(whole, best));
}

TEST_F(SmallModel, ALargeRegionHasTheMinimumOfAConvexModel)
{
  const Eigen::MatrixXd H = definite(7);
  const Vec best = -Z * (Z.transpose() * H * Z).ldlt().solve(Z.transpose() * g);
  const SparseMatrix sparse = H.sparseView();
  const TrustRegionStep step = TrustRegionModel(metric, sparse, none, g).step(1e6);
  expect_step_of_the_model(H, step, 1e6);
  EXPECT_FALSE(step.is_on_boundary);
  EXPECT_GT(step.predicted_decrease, 0.98 * decrease(H, best));
}

TEST_F(SmallModel, TheMetricsOwnModelIsSolvedAtOnce)
{
  const Vec best = -Z * (Z.transpose() * M * Z).ldlt().solve(Z.transpose() * g);
  const SparseMatrix sparse = M.sparseView();
  const TrustRegionModel model(metric, sparse, none, g);
  EXPECT_LT((model.step(1e6).d - best).norm(), 1e-6 * best.norm());
  EXPECT_NEAR(model.metric_norm(), std::sqrt(best.dot(M * best)), 1e-6 * model.metric_norm());
}

TEST_F(SmallModel, DecreasesMoreInALargerRegion)
{
  const Eigen::MatrixXd H = definite(7);
  const SparseMatrix sparse = H.sparseView();
  const TrustRegionModel model(metric, sparse, none, g);
  double last = 0;
  for (double radius = 1e-3 * model.metric_norm(); radius < model.metric_norm(); radius *= 2) {
    const TrustRegionStep step = model.step(radius);
    expect_step_of_the_model(H, step, radius);
    EXPECT_GT(step.predicted_decrease, last);
    last = step.predicted_decrease;
  }
}

TEST_F(SmallModel, FollowsNegativeCurvatureToTheBoundary)
{
  const Eigen::MatrixXd H = definite(7) - 20 * Eigen::MatrixXd::Identity(n, n);
  ASSERT_LT(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(Z.transpose() * H * Z).eigenvalues().minCoeff(), 0);
  const SparseMatrix sparse = H.sparseView();
  const TrustRegionModel model(metric, sparse, none, g);
  for (const double radius : {0.1, 1.0, 100.0}) {
    const TrustRegionStep step = model.step(radius);
    expect_step_of_the_model(H, step, radius);
    EXPECT_TRUE(step.is_on_boundary);
  }
  EXPECT_GT(model.step(100).predicted_decrease, 50 * model.step(10).predicted_decrease);
}

TEST_F(SmallModel, StandsStillWithoutASlope)
{
  const SparseMatrix H = definite(7).sparseView();
  const Vec flat = J.transpose() * wiggle(m, 3);
  EXPECT_LT(TrustRegionModel(metric, H, none, flat).step(1).d.norm(), 1e-5 * flat.norm());
  const Vec zero = Vec::Zero(n);
  EXPECT_EQ(TrustRegionModel(metric, H, none, zero).step(1).d.norm(), 0);
}

}  // namespace
}  // namespace softform::testing
