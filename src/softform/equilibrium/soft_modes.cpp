#include "softform/equilibrium/soft_modes.hpp"

#include <algorithm>

#include <Eigen/QR>
#include <Spectra/SymEigsSolver.h>

#include "softform/equilibrium/newton.hpp"
#include "softform/equilibrium/rigid_motions.hpp"

namespace softform {
namespace {

// P M^1/2 K^-1 M^1/2 P, P without rigid motions: its largest eigenvalues are 1 / sigma_i.
class Compliance {
 public:
  using Scalar = double;  // as Spectra asks for

  Compliance(const SparseFactorization& K, const Vec& masses, ConstVec x) : K_(K), roots_(masses.cwiseSqrt())
  {
    const Eigen::MatrixXd motions = roots_.asDiagonal() * rigid_motions(x);
    Eigen::HouseholderQR<Eigen::MatrixXd> qr(motions);
    rigid_ = qr.householderQ() * Eigen::MatrixXd::Identity(motions.rows(), motions.cols());
  }

  Eigen::Index rows() const { return roots_.size(); }
  Eigen::Index cols() const { return roots_.size(); }
  void perform_op(const double* in, double* out) const
  {
    const Vec force = roots_.cwiseProduct(projected(Eigen::Map<const Vec>(in, rows())));
    Eigen::Map<Vec>(out, rows()) = projected(roots_.cwiseProduct(K_.solve(force)));
  }
  Eigen::MatrixXd shapes(const Eigen::MatrixXd& vectors) const { return roots_.cwiseInverse().asDiagonal() * vectors; }

 private:
  Vec projected(const Vec& v) const { return v - rigid_ * (rigid_.transpose() * v); }

  const SparseFactorization& K_;
  Vec roots_;
  Eigen::MatrixXd rigid_;  // orthonormal
};

}  // namespace

SoftModes soft_modes(const SparseMatrix& K, const Vec& masses, ConstVec x, int count,
                     SparseFactorization& factorization)
{
  constexpr double rigid_shift = 1e-9, tolerance = 1e-10;
  constexpr int most_restarts = 100, rigid_count = 6;
  SparseMatrix shifted = K;
  shift_diagonal(shifted, rigid_shift * K.diagonal().cwiseAbs().mean());
  if (!factorization.cholesky(shifted)) return {};
  const int size = static_cast<int>(x.size());
  count = std::min(count, size - rigid_count - 1);
  Compliance compliance(factorization, masses, x);
  Spectra::SymEigsSolver<Compliance> solver(compliance, count, std::min(3 * count + 4, size));
  solver.init();
  if (solver.compute(Spectra::SortRule::LargestAlge, most_restarts, tolerance) < count) return {};
  return {solver.eigenvalues().cwiseInverse(), compliance.shapes(solver.eigenvectors())};
}

}  // namespace softform
