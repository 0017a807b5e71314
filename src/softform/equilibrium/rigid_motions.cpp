#include "softform/equilibrium/rigid_motions.hpp"

#include <Eigen/Geometry>
#include <Eigen/QR>

namespace softform {

Eigen::Matrix<double, Eigen::Dynamic, 6> rigid_motions(ConstVec x)
{
  const Positions nodes = unflatten(x);
  const Eigen::RowVector3d centroid = nodes.colwise().mean();
  Eigen::Matrix<double, Eigen::Dynamic, 6> motions(x.size(), 6);
  for (int i = 0; i < nodes.rows(); ++i) {
    const Vec3 arm = nodes.row(i) - centroid;
    for (int k = 0; k < 3; ++k) {
      motions.block<3, 1>(3 * i, k) = Vec3::Unit(k);
      motions.block<3, 1>(3 * i, 3 + k) = Vec3::Unit(k).cross(arm);
    }
  }
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(motions);
  return qr.householderQ() * Eigen::MatrixXd::Identity(x.size(), 6);
}

Vec without_rigid_motions(const Vec& b, ConstVec x)
{
  const auto motions = rigid_motions(x);
  return b - motions * (motions.transpose() * b);
}

}  // namespace softform
