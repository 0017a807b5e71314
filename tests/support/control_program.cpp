#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <vector>

#include <Eigen/SparseCholesky>

#include "support/test_programs.hpp"

namespace softform::testing {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double pi = std::numbers::pi;

class ControlProgram : public NonlinearProgram {
 public:
  ControlProgram(int m, double largest_control)
      : n_(m * m), mass_(1.0 / ((m + 1) * (m + 1))), largest_control_(largest_control * mass_), K_(n_, n_), target_(n_)
  {
    std::vector<Eigen::Triplet<double>> entries;
    for (int i = 0; i < m; ++i)
      for (int j = 0; j < m; ++j) {
        const int k = i * m + j;
        entries.emplace_back(k, k, 4);
        if (i > 0) entries.emplace_back(k, k - m, -1);
        if (i + 1 < m) entries.emplace_back(k, k + m, -1);
        if (j > 0) entries.emplace_back(k, k - 1, -1);
        if (j + 1 < m) entries.emplace_back(k, k + 1, -1);
        target_[k] = 0.2 * std::sin(pi * (i + 1.0) / (m + 1)) * std::sin(2 * pi * (j + 1.0) / (m + 1));
      }
    K_.setFromTriplets(entries.begin(), entries.end());
  }

  std::string name() const override { return "control"; }
  int variable_count() const override { return 2 * n_; }
  int constraint_count() const override { return n_; }
  Vec initial_point() const override { return Vec::Zero(2 * n_); }
  Vec lower_bounds() const override { return bounds(-largest_control_); }
  Vec upper_bounds() const override { return bounds(largest_control_); }

  double objective(ConstVec z) const override
  {
    return 0.5 * (z.head(n_) - target_).squaredNorm() + 0.5 * z.tail(n_).squaredNorm();
  }
  void objective_gradient(ConstVec z, Vec& g) const override
  {
    g.resize(2 * n_);
    g << z.head(n_) - target_, z.tail(n_);
  }
  void gauss_newton_hessian(ConstVec z, SparseMatrix& H) const override { lagrangian_hessian(z, Vec::Zero(n_), H); }
  void constraints(ConstVec z, Vec& c) const override
  {
    c = K_ * z.head(n_) + mass_ * z.head(n_).array().cube().matrix() - z.tail(n_);
  }
  void constraint_jacobian(ConstVec z, SparseMatrix& J) const override
  {
    std::vector<Eigen::Triplet<double>> entries;
    for (int j = 0; j < n_; ++j) {
      for (SparseMatrix::InnerIterator entry(K_, j); entry; ++entry)
        entries.emplace_back(static_cast<int>(entry.row()), j, entry.value());
      entries.emplace_back(j, j, 3 * mass_ * z[j] * z[j]);
      entries.emplace_back(j, n_ + j, -1);
    }
    J.resize(n_, 2 * n_);
    J.setFromTriplets(entries.begin(), entries.end());
  }
  bool lagrangian_hessian(ConstVec z, ConstVec lambda, SparseMatrix& H) const override
  {
    Vec diagonal(2 * n_);
    diagonal << (1 + 6 * mass_ * lambda.array() * z.head(n_).array()).matrix(), Vec::Ones(n_);
    H = SparseMatrix(diagonal.asDiagonal());
    return true;
  }
  // Newton's method for the state.
  std::optional<Vec> restore(ConstVec z) const override
  {
    Vec restored = z, c;
    SparseMatrix J;
    Eigen::SimplicialLLT<SparseMatrix> solver;
    for (int k = 0; k < 20; ++k) {
      constraints(restored, c);
      if (c.cwiseAbs().maxCoeff() < 1e-14) return restored;
      constraint_jacobian(restored, J);
      restored.head(n_) -= solver.compute(J.leftCols(n_)).solve(c);
    }
    return std::nullopt;
  }

 private:
  Vec bounds(double largest) const
  {
    Vec all(2 * n_);
    all << Vec::Constant(n_, std::copysign(infinity, largest)), Vec::Constant(n_, largest);
    return all;
  }

  int n_;
  double mass_, largest_control_;
  SparseMatrix K_;
  Vec target_;
};

}  // namespace

std::shared_ptr<const NonlinearProgram> control_program(int m, ControlBounds bounds)
{
  return std::make_shared<ControlProgram>(m, bounds == ControlBounds::Active ? 8 : infinity);
}

}  // namespace softform::testing
