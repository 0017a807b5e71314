#include "softform/objectives/vertex_distance.hpp"

#include <Eigen/Geometry>
#include <Eigen/SVD>

#include "softform/mesh/triangle_mesh.hpp"

namespace softform {

AlignedVertexDistance::AlignedVertexDistance(const Triangles& triangles, ConstVec target_positions)
    : target_(unflatten(target_positions)), weights_(vertex_areas(target_positions, triangles))
{
  const double size = diameter(target_);
  weights_ /= weights_.sum() * size * size;
}

// The weighted Procrustes problem (Kabsch 1976).
Positions AlignedVertexDistance::aligned_target(ConstVec x) const
{
  const Positions positions = unflatten(x);
  const Vec w = weights_ / weights_.sum();
  const Eigen::RowVector3d x_mean = w.transpose() * positions, t_mean = w.transpose() * target_;
  const Eigen::Matrix3d covariance =
      (positions.rowwise() - x_mean).transpose() * w.asDiagonal() * (target_.rowwise() - t_mean);
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Vec3 signs(1, 1, 1);
  if ((svd.matrixU() * svd.matrixV().transpose()).determinant() < 0) signs.z() = -1;
  const Eigen::Matrix3d R = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
  return ((target_.rowwise() - t_mean) * R.transpose()).rowwise() + x_mean;
}

double AlignedVertexDistance::value(ConstVec x) const
{
  return weights_.dot((unflatten(x) - aligned_target(x)).rowwise().squaredNorm());
}

void AlignedVertexDistance::gradient(ConstVec x, Vec& g) const
{
  const Positions weighted = 2 * weights_.asDiagonal() * (unflatten(x) - aligned_target(x));
  g = flatten(weighted);
}

void AlignedVertexDistance::gauss_newton_hessian(ConstVec x, SparseMatrix& H) const
{
  if (H.rows() != x.size() || H.nonZeros() != x.size()) {
    H.resize(x.size(), x.size());
    H.setIdentity();
  }
  for (Eigen::Index i = 0; i < x.size(); ++i) H.valuePtr()[i] = 2 * weights_[i / 3];
}

}  // namespace softform
