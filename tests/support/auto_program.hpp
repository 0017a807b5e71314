#pragma once

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <Eigen/Dense>
#include <unsupported/Eigen/AutoDiff>

#include "softform/optimizers/nonlinear_program.hpp"

namespace softform::testing {

/// A programme with exact derivatives from a model that gives n, m, start, lower and upper, and the templates
/// f(z) and c(z, out).
template <class Model>
class AutoProgram : public NonlinearProgram {
  static constexpr int n = Model::n, m = Model::m;
  using Gradient = Eigen::Matrix<double, n, 1>;
  using First = Eigen::AutoDiffScalar<Gradient>;
  using Second = Eigen::AutoDiffScalar<Eigen::Matrix<First, n, 1>>;
  using Dense = Eigen::MatrixXd;

 public:
  explicit AutoProgram(Model model = {}) : model_(std::move(model)) {}
  std::string name() const override { return Model::name; }
  int variable_count() const override { return n; }
  int constraint_count() const override { return m; }
  Vec initial_point() const override { return Eigen::Map<const Gradient>(model_.start.data()); }
  Vec lower_bounds() const override { return Eigen::Map<const Gradient>(model_.lower.data()); }
  Vec upper_bounds() const override { return Eigen::Map<const Gradient>(model_.upper.data()); }

  double objective(ConstVec z) const override { return model_.f(z.data()); }
  void objective_gradient(ConstVec z, Vec& g) const override { g = first(z)[0]; }
  void gauss_newton_hessian(ConstVec z, SparseMatrix& H) const override
  {
    // The positive part of the exact Hessian.
    const Eigen::SelfAdjointEigenSolver<Dense> eigen(hessian(z, Vec::Zero(m)));
    const Dense positive =
        eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0).asDiagonal() * eigen.eigenvectors().transpose();
    H = full(positive);
  }
  void constraints(ConstVec z, Vec& c) const override
  {
    c.resize(m);
    model_.c(z.data(), c.data());
  }
  void constraint_jacobian(ConstVec z, SparseMatrix& J) const override
  {
    const auto rows = first(z);
    Dense dense(m, n);
    for (int i = 0; i < m; ++i) dense.row(i) = rows[static_cast<std::size_t>(i) + 1];
    J = full(dense);
  }
  bool lagrangian_hessian(ConstVec z, ConstVec lambda, SparseMatrix& H) const override
  {
    H = full(hessian(z, lambda));
    return true;
  }

 private:
  static SparseMatrix full(const Dense& dense)
  {
    SparseMatrix sparse(dense.rows(), dense.cols());
    std::vector<Eigen::Triplet<double>> entries;
    for (int j = 0; j < dense.cols(); ++j)
      for (int i = 0; i < dense.rows(); ++i) entries.emplace_back(i, j, dense(i, j));
    sparse.setFromTriplets(entries.begin(), entries.end());
    return sparse;
  }
  std::array<Gradient, m + 1> first(ConstVec z) const
  {
    std::array<First, n> x;
    for (int i = 0; i < n; ++i) x[static_cast<std::size_t>(i)] = First(z[i], n, i);
    std::array<First, m + 1> y;
    for (First& value : y) value = First(0, Gradient::Zero());
    y[0] = model_.f(x.data());
    model_.c(x.data(), y.data() + 1);
    std::array<Gradient, m + 1> gradients;
    for (std::size_t k = 0; k <= m; ++k) gradients[k] = y[k].derivatives();
    return gradients;
  }
  Dense hessian(ConstVec z, ConstVec lambda) const
  {
    std::array<Second, n> x;
    for (int i = 0; i < n; ++i) {
      Second& xi = x[static_cast<std::size_t>(i)];
      xi.value() = First(z[i], n, i);
      for (int j = 0; j < n; ++j) xi.derivatives()[j] = First(i == j ? 1 : 0, Gradient::Zero());
    }
    std::array<Second, m + 1> y;
    y[0] = model_.f(x.data());
    model_.c(x.data(), y.data() + 1);
    Dense H = Dense::Zero(n, n);
    for (int k = 0; k <= m; ++k)
      for (int j = 0; j < n; ++j)
        H.row(j) += (k == 0 ? 1 : lambda[k - 1]) * y[static_cast<std::size_t>(k)].derivatives()[j].derivatives();
    return H;
  }

  Model model_;
};

}  // namespace softform::testing
