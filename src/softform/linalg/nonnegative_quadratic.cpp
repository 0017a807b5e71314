#include "softform/linalg/nonnegative_quadratic.hpp"

#include <vector>

#include <Eigen/Cholesky>

namespace softform {
namespace {

// The minimum over the free entries alone, zero elsewhere.
Vec minimum_of_free(const Eigen::MatrixXd& M, const Vec& q, const std::vector<int>& free)
{
  Vec y = Vec::Zero(q.size());
  y(free) = -M(free, free).llt().solve(q(free));
  return y;
}

}  // namespace

Vec nonnegative_minimum(const Eigen::MatrixXd& M, const Vec& q)
{
  Vec y = Vec::Zero(q.size());
  const double round_off = 1e-12 * q.lpNorm<Eigen::Infinity>();
  std::vector<int> free;
  for (Eigen::Index round = 0; round < 3 * q.size() + 10; ++round) {
    // The held entry along which the function falls fastest.
    Vec slope = M * y + q;
    for (const int j : free) slope[j] = 0;
    Eigen::Index entering = 0;
    if (slope.size() == 0 || !(slope.minCoeff(&entering) < -round_off)) break;
    free.push_back(static_cast<int>(entering));
    for (bool is_first = true;; is_first = false) {
      const Vec wanted = minimum_of_free(M, q, free);
      // An entry that falls along its slope, but not at the minimum of the free ones, has met round-off.
      if (is_first && wanted[entering] <= 0) return y;
      double length = 1;
      int blocking = -1;
      for (const int j : free) {
        if (wanted[j] > 0 || y[j] / (y[j] - wanted[j]) > length) continue;
        length = y[j] / (y[j] - wanted[j]);
        blocking = j;
      }
      y += length * (wanted - y);
      if (blocking < 0) break;
      y[blocking] = 0;
      std::erase(free, blocking);
    }
  }
  return y;
}

}  // namespace softform
