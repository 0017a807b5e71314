// The non-negative quadratic minimum against the best of all sets of free entries, and at round-off.

#include <cmath>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "softform/linalg/nonnegative_quadratic.hpp"

namespace softform::testing {
namespace {

Eigen::MatrixXd gram(int rows, int n, double phase)
{
  Eigen::MatrixXd A(rows, n);
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < n; ++j) A(i, j) = std::sin(1 + 3.1 * i + 1.7 * j * j + phase);
  return A.transpose() * A;
}

double value(const Eigen::MatrixXd& M, const Vec& q, const Vec& y) { return 0.5 * y.dot(M * y) + q.dot(y); }

// The least value over all sets of free entries whose minimum is not negative.
double least_of_all_sets(const Eigen::MatrixXd& M, const Vec& q)
{
  const int n = static_cast<int>(q.size());
  double least = 0;
  for (int set = 1; set < 1 << n; ++set) {
    std::vector<int> free;
    for (int j = 0; j < n; ++j)
      if (set >> j & 1) free.push_back(j);
    const Eigen::MatrixXd part = M(free, free);
    const Vec wanted = -part.llt().solve(q(free));
    if (wanted.minCoeff() < 0) continue;
    Vec y = Vec::Zero(n);
    y(free) = wanted;
    least = std::min(least, value(M, q, y));
  }
  return least;
}

TEST(NonnegativeMinimum, is_the_best_of_all_sets_of_free_entries)
{
  int held = 0;
  for (int k = 0; k < 20; ++k) {
    Eigen::MatrixXd M = gram(9, 6, 0.7 * k);
    M.diagonal().array() += 0.1;
    Vec q(6);
    for (int j = 0; j < 6; ++j) q[j] = std::cos(2.3 * j + 1.1 * k);
    const Vec y = nonnegative_minimum(M, q);
    EXPECT_GE(y.minCoeff(), 0);
    EXPECT_NEAR(value(M, q, y), least_of_all_sets(M, q), 1e-9 * (1 + std::abs(value(M, q, y)))) << k;
    held += static_cast<int>((y.array() == 0).count());
  }
  EXPECT_GT(held, 10);  // the bounds were in the way
}

// Columns that depend on each other, but for a trace: entries were freed and held again in turn, without end.
TEST(NonnegativeMinimum, ends_at_round_off)
{
  Eigen::MatrixXd M = gram(20, 80, 0);
  M.diagonal().array() += 1e-12 * M.diagonal().mean();
  Vec q(80);
  for (int j = 0; j < 80; ++j) q[j] = std::cos(2.3 * j);
  const Vec y = nonnegative_minimum(M, q);
  EXPECT_TRUE(y.allFinite());
  EXPECT_GE(y.minCoeff(), 0);
  EXPECT_LT(value(M, q, y), 0);
}

TEST(NonnegativeMinimum, of_nothing_is_nothing)
{
  EXPECT_EQ(nonnegative_minimum(Eigen::MatrixXd(0, 0), Vec(0)).size(), 0);
  EXPECT_EQ(nonnegative_minimum(Eigen::MatrixXd::Identity(3, 3), Vec::Ones(3)), Vec::Zero(3));
}

}  // namespace
}  // namespace softform::testing
