#pragma once

#include "softform/core/types.hpp"

namespace softform {

struct RbfOptions {
  /// Kernel centres, a third of them on the surface: the dense system of that size is factorised once.
  int centres = 800;
  /// Distance of the off-surface points on both sides [m]: well above the noise, well below the radius of curvature.
  double offset = 2e-3;
  /// Weight of smoothness against interpolation, dimensionless; 0 interpolates.
  double smoothing = 1e-4;
  /// Neighbours that the normal of a point is taken from.
  int neighbours = 30;
};

/// An implicit surface through a point cloud (J. C. Carr et al., SIGGRAPH 2001): the triharmonic interpolant
///     s(x) = sum_j w_j |x - c_j|^3 + a linear polynomial,
/// 0 at points of the cloud and plus or minus the offset at points on either side of it, so that s is close to the
/// signed distance d_RBF of (4.9) near the surface, negative inside. Holes of the cloud are filled smoothly.
class RbfImplicit {
 public:
  /// points: (n, 3) [m]; `inside`: a point that every part of the surface faces away from, which orients the normals.
  /// Throws InputError where there are fewer points than centres on the surface or neighbours, or one is not finite.
  /// `edge` (k, 3): points that the surface is known to pass through, more centres where no cloud gives a normal.
  RbfImplicit(const Positions& points, const Vec3& inside, const RbfOptions& options = {}, const Positions& edge = {});

  /// points with their outward unit normals, (n, 3) each; of fewer points than centres / 3 all are taken.
  /// Throws InputError where one is not finite.
  static RbfImplicit from_normals(const Positions& points, const Positions& normals, const RbfOptions& options = {});

  /// s(x) [m].
  double value(const Vec3& x) const;
  /// s(x), with `gradient` ds/dx (3).
  double value(const Vec3& x, Vec3& gradient) const;

  /// The point of the surface that x comes to along the gradient, by Newton's method.
  Vec3 project(Vec3 x) const;

 private:
  RbfImplicit() = default;
  void fit(const Positions& points, const Positions& normals, const Positions& edge, const RbfOptions& options);
  void solve(Vec values, double smoothing);

  double unit_ = 1;  // length that makes coordinates dimensionless [m]
  Eigen::Matrix3Xd centres_;
  Vec weights_;
  Eigen::Vector4d polynomial_;
};

}  // namespace softform
