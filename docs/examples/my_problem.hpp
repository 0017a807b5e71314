#pragma once

#include <utility>

#include "softform/optimizers/nonlinear_program.hpp"

/// The point of the unit sphere that is closest to a target t:  min 1/2 |z - t|^2  subject to  |z|^2 = 1.
class ClosestPoint : public softform::NonlinearProgram {
  using Vec = softform::Vec;
  using ConstVec = softform::ConstVec;
  using SparseMatrix = softform::SparseMatrix;

 public:
  explicit ClosestPoint(Vec target) : target_(std::move(target)) {}
  std::string name() const override { return "closest point"; }
  int variable_count() const override { return static_cast<int>(target_.size()); }
  int constraint_count() const override { return 1; }
  Vec initial_point() const override { return Vec::Ones(target_.size()); }

  double objective(ConstVec z) const override { return 0.5 * (z - target_).squaredNorm(); }
  void objective_gradient(ConstVec z, Vec& g) const override { g = z - target_; }
  void gauss_newton_hessian(ConstVec z, SparseMatrix& H) const override { set_diagonal(z.size(), 1, H); }
  void constraints(ConstVec z, Vec& c) const override { c = Vec::Constant(1, z.squaredNorm() - 1); }
  void constraint_jacobian(ConstVec z, SparseMatrix& J) const override
  {
    J.resize(1, z.size());
    for (Eigen::Index i = 0; i < z.size(); ++i) J.insert(0, i) = 2 * z[i];
    J.makeCompressed();
  }
  // Optional: methods that want it converge quadratically.
  bool lagrangian_hessian(ConstVec z, ConstVec lambda, SparseMatrix& H) const override
  {
    set_diagonal(z.size(), 1 + 2 * lambda[0], H);
    return true;
  }

 private:
  static void set_diagonal(Eigen::Index n, double value, SparseMatrix& H)
  {
    H.resize(n, n);
    H.setIdentity();
    H *= value;
  }
  Vec target_;
};
