#pragma once

#include <memory>
#include <utility>

#include "softform/equilibrium/soft_modes.hpp"
#include "softform/inverse/coupled_objective.hpp"
#include "softform/inverse/full_space_program.hpp"

namespace softform {

/// Keeps the equilibria of a design from giving way:
///     weight sum_i b(sigma_i),   b(t) = -(1 - t)^2 log t for t < 1, and 0 beyond,
/// over the soft modes K v_i = sigma_i M v_i of the tangent: the barrier of incremental potential contact (Li et al.
/// 2020), here against a loss of stability. Being a function of K's whole spectrum it is smooth where modes change
/// places. It is infinite where the tangent is not definite: for methods whose iterates are stable equilibria.
class StabilityBarrier : public CoupledObjective {
 public:
  /// masses (3n): M, in the units of K where the barrier begins, sigma = 1. The body is free to move.
  StabilityBarrier(std::shared_ptr<EquilibriumConstraint> constraint, Vec masses, double weight)
      : constraint_(std::move(constraint)), masses_(std::move(masses)), weight_(weight)
  {}

  double value(ConstVec x, ConstVec p) override;
  Vec gradient(ConstVec x, ConstVec p) override;
  /// Without the second derivatives of sigma_i.
  Eigen::MatrixXd curvature_factors(ConstVec x, ConstVec p) override;
  int linear_solves() const override { return factorization_.attempts(); }

 private:
  void find_modes(ConstVec x, ConstVec p);
  void find_gradients(ConstVec x, ConstVec p);

  std::shared_ptr<EquilibriumConstraint> constraint_;
  Vec masses_;
  double weight_;
  SparseFactorization factorization_;
  SparseMatrix K_, xx_, mixed_, pp_;
  // Of the last state and design, whose value, gradient and curvature are asked for in turn.
  Vec x_, p_;
  SoftModes modes_;
  Eigen::MatrixXd gradients_;  // of sigma_i < 1 by (x, p); no rows before they are asked for
};

}  // namespace softform
