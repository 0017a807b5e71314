#pragma once

#include <vector>

#include "softform/equilibrium/potential.hpp"
#include "softform/fem/solid.hpp"
#include "softform/optimizers/nonlinear_program.hpp"

namespace softform {

/// The sparse regulariser (5.9) with the smoothing that makes it differentiable at zero:
///     R(q) = weight sum_j (sum_i |q_j^i|^2 + smoothing^2)^(1/alpha)
/// over the candidates j and the poses i.
struct SparseRegularizer {
  double weight = 0;     ///< k_sparse [mm^2 / N^(2/alpha)]
  double alpha = 4;      ///< 2 is the group norm, which penalises large forces as well; more prefers few
  double smoothing = 0;  ///< [N]
};

/// Full-space programme of the first stage (5.6 with 5.9): find the poses x^i and the nodal forces q^i at candidate
/// vertices, shared by all poses, that balance the body's elastic forces,
///     min  1/2 sum_i |x^i - t^i|^2 + R(q)   subject to   dW/dx(x^i) = S q^i,
/// where the rows of coordinates that are held say x_k^i = X_k instead. No candidate is held.
/// Variables z = (x^1, ..., x^p, q^1, ..., q^p) in mm and N, so that all numbers are near one. The Hessian of R is that
/// of its quadratic majoriser (iterative reweighting): R itself is concave in |q|.
class SparseActuationProgram : public NonlinearProgram {
 public:
  /// targets: (2n) [m] each. The body's densities are all zero: one soft material. The body must outlive this object.
  SparseActuationProgram(const PlanarSolid& body, std::vector<Vec> targets, std::vector<int> candidates,
                         SparseRegularizer regularizer, FixedDofs held = {});

  std::string name() const override { return "sparse_actuation"; }
  int variable_count() const override { return pose_count() * (state_size() + force_size()); }
  int constraint_count() const override { return pose_count() * state_size(); }
  /// The targets with the forces that they need at the candidates, or what start_from() was given.
  Vec initial_point() const override;
  void start_from(Vec z) { start_ = std::move(z); }
  /// z of the poses (2n) [m] with the forces that they need at the candidates.
  Vec point_from(const std::vector<Vec>& positions) const;
  void set_smoothing(double smoothing) { regularizer_.smoothing = smoothing; }

  double objective(ConstVec z) const override;
  void objective_gradient(ConstVec z, Vec& g) const override;
  void gauss_newton_hessian(ConstVec z, SparseMatrix& H) const override;
  void constraints(ConstVec z, Vec& c) const override;
  void constraint_jacobian(ConstVec z, SparseMatrix& J) const override;
  bool lagrangian_hessian(ConstVec z, ConstVec lambda, SparseMatrix& H) const override;

  int pose_count() const { return static_cast<int>(targets_.size()); }
  const std::vector<int>& candidates() const { return candidates_; }
  /// Positions of a pose (2n) [m].
  Vec positions(ConstVec z, int pose) const;
  /// Forces of a pose on the candidates, (2 candidates) [N].
  Vec forces(ConstVec z, int pose) const;
  /// 1/2 sum_i |x^i - t^i|^2 [mm^2].
  double squared_error(ConstVec z) const;
  /// |(q_j^1, ..., q_j^p)| of the candidates [N].
  Vec force_norms(ConstVec z) const;

 private:
  int state_size() const { return 2 * body_.vertex_count(); }
  int force_size() const { return 2 * static_cast<int>(candidates_.size()); }
  Eigen::Index force_start(int pose) const { return Eigen::Index(pose_count()) * state_size() + pose * force_size(); }
  Vec majorizer_weights(ConstVec z) const;
  bool is_held(Eigen::Index k) const { return held_.free.size() > 0 && held_.free[k] == 0; }

  const PlanarSolid& body_;
  std::vector<Vec> targets_;
  std::vector<int> candidates_;
  SparseRegularizer regularizer_;
  FixedDofs held_;
  double hold_stiffness_;  // makes forces of the distances of held coordinates [N/m]
  Vec start_, densities_;
  mutable SparseMatrix K_, mixed_;
};

}  // namespace softform
