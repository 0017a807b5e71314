// Sparse factorisation, sums and the normal matrix against dense algebra.

#include <cmath>
#include <vector>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "softform/linalg/sparse_factorization.hpp"
#include "softform/linalg/sparse_sum.hpp"
#include "softform/optimizers/normal_matrix.hpp"
#include "support/deformations.hpp"

namespace softform::testing {
namespace {

using Dense = Eigen::MatrixXd;

SparseMatrix sparse(const Dense& dense) { return dense.sparseView(); }

// The 5-point Laplacian of a k x k grid: positive definite, eigenvalues 4 - 2 cos(i pi/(k+1)) - 2 cos(j pi/(k+1)).
SparseMatrix grid_laplacian(int k)
{
  std::vector<Eigen::Triplet<double>> entries;
  for (int j = 0; j < k; ++j) {
    for (int i = 0; i < k; ++i) {
      const int a = j * k + i;
      entries.emplace_back(a, a, 4.0);
      const auto couple = [&](int b) {
        entries.emplace_back(a, b, -1.0);
        entries.emplace_back(b, a, -1.0);
      };
      if (i + 1 < k) couple(a + 1);
      if (j + 1 < k) couple(a + k);
    }
  }
  SparseMatrix A(k * k, k * k);
  A.setFromTriplets(entries.begin(), entries.end());
  return A;
}

SparseMatrix shifted(SparseMatrix A, double shift)
{
  for (int j = 0; j < A.cols(); ++j) A.coeffRef(j, j) += shift;
  return A;
}

int negative_eigenvalues(const SparseMatrix& A)
{
  const Vec eigenvalues = Eigen::SelfAdjointEigenSolver<Dense>(Dense(A)).eigenvalues();
  return static_cast<int>((eigenvalues.array() < 0).count());
}

TEST(SparseFactorization, CholeskySolves)
{
  const SparseMatrix A = grid_laplacian(20);
  const Vec b = wiggle(400, 3);
  SparseFactorization factorization;
  ASSERT_TRUE(factorization.cholesky(A));
  EXPECT_EQ(factorization.negative_eigenvalues(), 0);
  EXPECT_LT((factorization.solve(b) - Dense(A).llt().solve(b)).norm(), 1e-11 * b.norm());
  EXPECT_GE(factorization.factor_nonzeros(), static_cast<double>(A.nonZeros()) / 2);
}

TEST(SparseFactorization, ReadsTheLowerTriangleOnly)
{
  const SparseMatrix A = grid_laplacian(8);
  SparseMatrix lower = A.triangularView<Eigen::Lower>();
  lower.makeCompressed();
  const Vec b = wiggle(64, 5);
  SparseFactorization full, half;
  ASSERT_TRUE(full.cholesky(A) && half.cholesky(lower));
  EXPECT_LT((full.solve(b) - half.solve(b)).norm(), 1e-12 * b.norm());
}

TEST(SparseFactorization, InertiaIsThatOfTheEigenvalues)
{
  const SparseMatrix A = grid_laplacian(9);
  const Vec b = wiggle(81, 4);
  SparseFactorization factorization;
  for (const double shift : {-0.5, -1.3, -2.7, -3.9, -8.5}) {
    const SparseMatrix B = shifted(A, shift);
    EXPECT_FALSE(factorization.cholesky(B)) << shift;
    ASSERT_TRUE(factorization.indefinite(B)) << shift;
    EXPECT_EQ(factorization.negative_eigenvalues(), negative_eigenvalues(B)) << shift;
    EXPECT_GT(factorization.negative_eigenvalues(), 0);
    EXPECT_LT((B * factorization.solve(b) - b).norm(), 1e-9 * b.norm()) << shift;
  }
  ASSERT_TRUE(factorization.cholesky(A));
  EXPECT_LT((A * factorization.solve(b) - b).norm(), 1e-11 * b.norm());
}

TEST(SparseFactorization, SingularIsRefused)
{
  Dense A = Dense::Zero(3, 3);
  A.diagonal() << 1, 0, 2;
  SparseMatrix singular = sparse(A);
  singular.coeffRef(1, 1) = 0;  // stored
  singular.makeCompressed();
  SparseFactorization factorization;
  EXPECT_FALSE(factorization.cholesky(singular));
  EXPECT_FALSE(factorization.indefinite(singular));
  EXPECT_EQ(factorization.negative_eigenvalues(), -1);
}

// Another pattern of the same size, and even of the same number of entries, is analysed anew.
TEST(SparseFactorization, ChangedPatternIsAnalysedAgain)
{
  const int k = 10, n = k * k;
  const SparseMatrix A = grid_laplacian(k);
  // The same graph with its vertices renumbered has as many entries in other places.
  Eigen::PermutationMatrix<Eigen::Dynamic> renumber(n);
  for (int i = 0; i < n; ++i) renumber.indices()[i] = (37 * i + 11) % n;
  SparseMatrix permuted(n, n);
  permuted = A.twistedBy(renumber);
  ASSERT_EQ(permuted.nonZeros(), A.nonZeros());
  const Vec b = wiggle(n, 7), small_b = wiggle(25, 7);
  SparseFactorization factorization;
  for (const SparseMatrix& matrix : {A, permuted, A}) {
    ASSERT_TRUE(factorization.cholesky(matrix));
    EXPECT_LT((matrix * factorization.solve(b) - b).norm(), 1e-11 * b.norm());
    const SparseMatrix indefinite = shifted(matrix, -1.3);
    ASSERT_TRUE(factorization.indefinite(indefinite));
    EXPECT_LT((indefinite * factorization.solve(b) - b).norm(), 1e-9 * b.norm());
  }
  const SparseMatrix small = grid_laplacian(5);
  ASSERT_TRUE(factorization.cholesky(small));
  EXPECT_LT((small * factorization.solve(small_b) - small_b).norm(), 1e-11 * small_b.norm());
}

// A deterministic matrix with gaps.
Dense with_gaps(int rows, int columns, int seed)
{
  Dense A(rows, columns);
  for (int j = 0; j < columns; ++j)
    for (int i = 0; i < rows; ++i) A(i, j) = (3 * i + 5 * j + seed) % 4 == 0 ? std::sin(i * seed + 2 * j + 1) : 0;
  return A;
}

Dense symmetric_with_gaps(int n, int seed)
{
  const Dense A = with_gaps(n, n, seed);
  return A + A.transpose();
}

Dense lower_triangle(const Dense& A) { return A.triangularView<Eigen::Lower>(); }

TEST(NormalMatrix, IsTheDenseSum)
{
  const int n = 12;
  NormalMatrix normal;
  for (const double factor : {1.0, -2.5}) {  // the second time on the pattern of the first
    const Dense H = factor * symmetric_with_gaps(n, 1), J = factor * with_gaps(7, n, 2),
                D = factor * symmetric_with_gaps(n, 3);
    const Dense expected = H + 50 * J.transpose() * J + 0.3 * D;
    const Dense found = normal.assemble(sparse(H), sparse(J), 50, sparse(D), 0.3);
    EXPECT_LT((found - lower_triangle(expected)).cwiseAbs().maxCoeff(), 1e-10);
    const Dense damped = normal.with_damping(sparse(D), 7);
    EXPECT_LT((damped - lower_triangle(expected + 6.7 * D)).cwiseAbs().maxCoeff(), 1e-10);
  }
}

TEST(NormalMatrix, WithoutConstraints)
{
  const Dense H = symmetric_with_gaps(9, 1), D = symmetric_with_gaps(9, 2);
  const Dense found = NormalMatrix().assemble(sparse(H), SparseMatrix(0, 9), 50, sparse(D), 2);
  EXPECT_LT((found - lower_triangle(H + 2 * D)).cwiseAbs().maxCoeff(), 1e-10);
}

TEST(SparseSum, AddsBlocksAtTheirPlaces)
{
  const Dense A = symmetric_with_gaps(4, 1), B = symmetric_with_gaps(3, 2), C = symmetric_with_gaps(7, 3);
  SparseSum sum(7);
  for (const double weight : {2.0, -0.5}) {
    Dense expected = weight * C;
    expected.topLeftCorner(4, 4) += A;
    expected.block(4, 1, 3, 3) += 3 * B;
    sum.clear();
    sum.add(sparse(A), 1, 0, 0);
    sum.add(sparse(B), 3, 4, 1);
    sum.add(sparse(C), weight, 0, 0);
    EXPECT_LT((Dense(sum.matrix()) - expected).cwiseAbs().maxCoeff(), 1e-14);
    EXPECT_TRUE(sum.matrix().isCompressed());
  }
}

TEST(SparseSum, ScaledSumIntoALowerTriangle)
{
  const Dense A = symmetric_with_gaps(5, 1), T = Dense::Ones(8, 8);
  SparseMatrix target = sparse(lower_triangle(T));
  add_scaled(sparse(A), -2, target, 3, 3);
  Dense expected = T;
  expected.bottomRightCorner(5, 5) -= 2 * A;
  EXPECT_LT((Dense(target) - lower_triangle(expected)).cwiseAbs().maxCoeff(), 1e-14);
}

}  // namespace
}  // namespace softform::testing
