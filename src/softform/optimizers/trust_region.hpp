#pragma once

#include "softform/optimizers/kkt_system.hpp"

namespace softform {

/// A step within a trust region.
struct TrustRegionStep {
  Vec d;
  double norm = 0;                ///< |d|_M
  double predicted_decrease = 0;  ///< -(g . d + d . (H + U U^t) d / 2)
  bool is_on_boundary = false;
};

/// The quadratic model g . d + d . (H + U U^t) d / 2 on the null space of J, H symmetric but not necessarily convex
/// there and U of few columns, with regions measured by |d|_M^2 = d . M d, where the KKT system of M and J is
/// factorised and convex.
///
/// Its steps are those of conjugate gradients preconditioned by M, with every residual projected by that system (Gould,
/// Hribar and Nocedal 2001), up to the boundary or to a direction without positive curvature, which is followed to the
/// boundary (Steihaug 1983). A smaller region costs no factorisation.
class TrustRegionModel {
 public:
  /// metric, H, U and g outlive this object.
  TrustRegionModel(const KktSystem& metric, const SparseMatrix& H, const Eigen::MatrixXd& U, const Vec& g);

  /// |d|_M of M's own step, H = M: a first radius.
  double metric_norm() const;
  /// Precondition: radius > 0.
  TrustRegionStep step(double radius) const;

 private:
  TrustRegionStep with_decrease(TrustRegionStep step) const;
  Vec product(const Vec& d) const { return H_ * d + U_ * (U_.transpose() * d); }
  Vec project(const Vec& r) const { return -metric_.solve(r, zero_, projection_tolerance).d; }

  static constexpr double projection_tolerance = 1e-7;

  const KktSystem& metric_;
  const SparseMatrix& H_;
  const Eigen::MatrixXd& U_;
  const Vec& g_;
  Vec zero_, projected_;
};

}  // namespace softform
