#include "softform/optimizers/kkt_system.hpp"

#include <algorithm>
#include <vector>

namespace softform {
namespace {

double largest_entry(const SparseMatrix& A) { return A.nonZeros() > 0 ? A.coeffs().abs().maxCoeff() : 0; }

double positive_or_one(double value) { return value > 0 ? value : 1; }

SparseMatrix lower_triangle(const SparseMatrix& W, const SparseMatrix& J, double regularization)
{
  const int n = static_cast<int>(W.cols()), m = static_cast<int>(J.rows());
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(static_cast<std::size_t>(W.nonZeros() / 2 + J.nonZeros() + 2 * n + m));
  for (int j = 0; j < n; ++j) {
    for (SparseMatrix::InnerIterator entry(W, j); entry; ++entry)
      if (entry.row() >= j) entries.emplace_back(static_cast<int>(entry.row()), j, entry.value());
    entries.emplace_back(j, j, 0.0);  // the pattern has the diagonal
    for (SparseMatrix::InnerIterator entry(J, j); entry; ++entry)
      entries.emplace_back(n + static_cast<int>(entry.row()), j, entry.value());
  }
  for (int i = 0; i < m; ++i) entries.emplace_back(n + i, n + i, -regularization);
  SparseMatrix K(n + m, n + m);
  K.setFromTriplets(entries.begin(), entries.end());
  return K;
}

}  // namespace

bool KktSystem::factorize(const SparseMatrix& W, const SparseMatrix& J)
{
  W_ = W;
  J_ = J;
  const double j = largest_entry(J);
  const double e = regularization_ * positive_or_one(j * j) / positive_or_one(largest_entry(W));
  return factorization_.factorize(lower_triangle(W, J, e));
}

KktSystem::Step KktSystem::solve(ConstVec a, ConstVec c, double tolerance) const
{
  constexpr int most_refinements = 20;
  const Eigen::Index n = a.size(), m = c.size();
  Vec rhs(n + m);
  rhs << -a, -c;
  Step best{Vec::Zero(n), Vec::Zero(m), a, c, 1, 0};
  const double size = rhs.norm();
  if (!(size > 0)) return best;
  Step step = best;
  do {
    const Vec correction = factorization_.solve(rhs);
    ++step.solves;
    step.d += correction.head(n);
    step.delta += correction.tail(m);
    step.rho = W_ * step.d + J_.transpose() * step.delta + a;
    step.r = J_ * step.d + c;
    rhs << -step.rho, -step.r;
    step.relative_residual = rhs.norm() / size;
    const bool is_better = step.solves == 1 || step.relative_residual < 0.9 * best.relative_residual;
    best.solves = step.solves;
    if (!is_better) return best;
    best = step;
  } while (best.relative_residual > tolerance && best.solves <= most_refinements);
  return best;
}

Vec least_squares_multipliers(ConstVec g, const SparseMatrix& J)
{
  if (J.rows() == 0) return Vec(0);
  SparseMatrix identity(J.cols(), J.cols());
  identity.setIdentity();
  KktSystem system;
  if (!system.factorize(identity, J)) return Vec::Zero(J.rows());
  return system.solve(g, Vec::Zero(J.rows()), 1e-12).delta;
}

}  // namespace softform
