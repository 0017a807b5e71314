// MUMPS on symmetric indefinite matrices against dense algebra: solutions, inertia, singular and changing matrices.

#include <cmath>
#include <limits>
#include <stdexcept>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "softform/linalg/symmetric_indefinite.hpp"
#include "support/deformations.hpp"

namespace softform::testing {
namespace {

using Dense = Eigen::MatrixXd;

// [H J^t; J -delta I] with a diagonally shifted H (n, n) and J (m, n), deterministic and dense enough to need pivots.
Dense kkt_matrix(int n, int m, double shift, double delta)
{
  const Dense A = Eigen::Map<const Dense>(Vec(wiggle(n * n, 1)).data(), n, n);
  Dense K = Dense::Zero(n + m, n + m);
  K.topLeftCorner(n, n) = A + A.transpose() + shift * Dense::Identity(n, n);
  K.bottomLeftCorner(m, n) = Eigen::Map<const Dense>(Vec(wiggle(m * n, 2)).data(), m, n);
  K.topRightCorner(n, m) = K.bottomLeftCorner(m, n).transpose();
  K.bottomRightCorner(m, m).diagonal().setConstant(-delta);
  return K;
}

int negative_eigenvalues(const Dense& A)
{
  return static_cast<int>((Eigen::SelfAdjointEigenSolver<Dense>(A).eigenvalues().array() < 0).count());
}

SparseMatrix sparse(const Dense& A) { return A.sparseView(); }

TEST(SymmetricIndefinite, AgreesWithDenseAlgebra)
{
  for (const double shift : {-1.0, 0.0, 0.3, 5.0, 100.0}) {
    const Dense K = kkt_matrix(30, 11, shift, 0);
    const Vec b = wiggle(41, 3);
    SymmetricIndefinite factorization;
    ASSERT_TRUE(factorization.factorize(sparse(K)));
    EXPECT_EQ(factorization.negative_eigenvalues(), negative_eigenvalues(K)) << "shift " << shift;
    const Vec x = factorization.solve(b);
    EXPECT_LT((x - K.fullPivLu().solve(b)).norm(), 1e-10 * x.norm()) << "shift " << shift;
    EXPECT_LT((K * x - b).norm(), 1e-12 * (K.norm() * x.norm()));
  }
}

// Both inertias occur among the shifts above: otherwise the comparison would say little.
TEST(SymmetricIndefinite, ShiftsSpanTheInertias)
{
  EXPECT_GT(negative_eigenvalues(kkt_matrix(30, 11, -1, 0)), 11);
  EXPECT_EQ(negative_eigenvalues(kkt_matrix(30, 11, 100, 0)), 11);
}

TEST(SymmetricIndefinite, ReadsTheLowerTriangleOnly)
{
  const Dense K = kkt_matrix(8, 3, 10, 0);
  SymmetricIndefinite factorization;
  ASSERT_TRUE(factorization.factorize(sparse(Dense(K.triangularView<Eigen::Lower>()))));
  const Vec b = wiggle(11, 4);
  EXPECT_LT((K * factorization.solve(b) - b).norm(), 1e-11);
}

TEST(SymmetricIndefinite, FollowsValuesAndPatterns)
{
  SymmetricIndefinite factorization;
  for (const int n : {6, 6, 9, 4}) {
    for (const double shift : {2.0, 7.0}) {
      const Dense K = kkt_matrix(n, 2, shift, 0);
      const Vec b = wiggle(n + 2, 5);
      ASSERT_TRUE(factorization.factorize(sparse(K)));
      EXPECT_LT((K * factorization.solve(b) - b).norm(), 1e-11);
      EXPECT_EQ(factorization.negative_eigenvalues(), negative_eigenvalues(K));
    }
  }
}

TEST(SymmetricIndefinite, RefinesIllConditionedSystems)
{
  Dense K = kkt_matrix(20, 5, 50, 0);
  const Vec scale = Vec::LinSpaced(25, -5, 5).unaryExpr([](double e) { return std::pow(10, e); });
  K = scale.asDiagonal() * K * scale.asDiagonal();
  const Vec b = K * Vec::Ones(25);
  SymmetricIndefinite factorization;
  ASSERT_TRUE(factorization.factorize(sparse(K)));
  const Vec x = factorization.solve(b);
  const Vec backward_error = (K * x - b).cwiseAbs().cwiseQuotient(K.cwiseAbs() * x.cwiseAbs() + b.cwiseAbs());
  EXPECT_LT(backward_error.maxCoeff(), 1e-14);
}

// Dependent rows of J make the matrix singular; -delta I below heals it.
TEST(SymmetricIndefinite, SaysWhenSingular)
{
  Dense K = kkt_matrix(6, 2, 10, 0);
  K.row(7) = K.row(6);
  K.col(7) = K.col(6);
  SymmetricIndefinite factorization;
  EXPECT_FALSE(factorization.factorize(sparse(K)));
  EXPECT_THROW(factorization.solve(Vec::Ones(8)), std::runtime_error);
  K.diagonal().tail(2).setConstant(-1e-8);
  ASSERT_TRUE(factorization.factorize(sparse(K)));
  EXPECT_EQ(factorization.negative_eigenvalues(), 2);
}

TEST(SymmetricIndefinite, RefusesNan)
{
  Dense K = kkt_matrix(6, 2, 10, 0);
  K(3, 1) = std::numeric_limits<double>::quiet_NaN();
  SymmetricIndefinite factorization;
  EXPECT_FALSE(factorization.factorize(sparse(K)));
  EXPECT_TRUE(factorization.factorize(sparse(kkt_matrix(6, 2, 10, 0))));
}

TEST(SymmetricIndefinite, InstancesAreIndependent)
{
  const Dense K = kkt_matrix(6, 2, 10, 0), L = kkt_matrix(9, 4, 10, 0);
  SymmetricIndefinite first, second;
  ASSERT_TRUE(first.factorize(sparse(K)));
  ASSERT_TRUE(second.factorize(sparse(L)));
  EXPECT_LT((K * first.solve(Vec::Ones(8)) - Vec::Ones(8)).norm(), 1e-10);
  EXPECT_LT((L * second.solve(Vec::Ones(13)) - Vec::Ones(13)).norm(), 1e-10);
}

}  // namespace
}  // namespace softform::testing
