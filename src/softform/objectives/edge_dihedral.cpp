#include "softform/objectives/edge_dihedral.hpp"

#include <array>
#include <cmath>

#include <Eigen/Geometry>

namespace softform {

// Normals n1 = (b - a) x (c - a) and n2 = (d - a) x (b - a), both outwards.
double dihedral_angle(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
{
  const Vec3 e = b - a;
  const Vec3 n1 = e.cross(c - a);
  const Vec3 n2 = (d - a).cross(e);
  return std::atan2(n1.cross(n2).dot(e) / e.norm(), n1.dot(n2));
}

// Grinspun et al. 2003; the angle grows when c or d moves against its normal.
Eigen::Matrix<double, 12, 1> dihedral_gradient(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
{
  const Vec3 e = b - a;
  const double length = e.norm();
  const Vec3 n1 = e.cross(c - a);
  const Vec3 n2 = (d - a).cross(e);
  const Vec3 grad_c = -length / n1.squaredNorm() * n1;
  const Vec3 grad_d = -length / n2.squaredNorm() * n2;
  // Barycentric places of c and d along the edge give the share of each end.
  const double s_c = (c - a).dot(e) / (length * length);
  const double s_d = (d - a).dot(e) / (length * length);
  Eigen::Matrix<double, 12, 1> gradient;
  gradient << -(1 - s_c) * grad_c - (1 - s_d) * grad_d, -s_c * grad_c - s_d * grad_d, grad_c, grad_d;
  return gradient;
}

EdgeDihedralDistance::EdgeDihedralDistance(const Triangles& triangles, ConstVec target_positions,
                                           EdgeDihedralWeights weights)
    : weights_(weights)
{
  const int vertex_count = static_cast<int>(target_positions.size() / 3);
  for (const Edge& edge : edges_of(triangles, vertex_count))
    flaps_.push_back({edge.start, edge.end, edge.left, edge.right, 0, 0, 0});
  set_target(target_positions);

  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(flaps_.size() * 144);
  for (const Flap& flap : flaps_) {
    const std::array<int, 4> v{flap.start, flap.end, flap.left, flap.right < 0 ? flap.left : flap.right};
    for (int i : v)
      for (int j : v)
        for (int p = 0; p < 3; ++p)
          for (int q = 0; q < 3; ++q) entries.emplace_back(3 * i + p, 3 * j + q, 0.0);
  }
  pattern_.resize(3 * vertex_count, 3 * vertex_count);
  pattern_.setFromTriplets(entries.begin(), entries.end());
  for (const Flap& flap : flaps_) {
    const std::array<int, 4> v{flap.start, flap.end, flap.left, flap.right < 0 ? flap.left : flap.right};
    for (int j : v)
      for (int i : v)
        slots_.push_back(static_cast<int>(&pattern_.coeffRef(3 * i, 3 * j) - pattern_.valuePtr()) -
                         pattern_.outerIndexPtr()[3 * j]);
  }
}

void EdgeDihedralDistance::set_target(ConstVec target_positions)
{
  double total_length = 0;
  for (Flap& flap : flaps_) {
    const Vec3 a = vertex(target_positions, flap.start), b = vertex(target_positions, flap.end);
    flap.length = (b - a).norm();
    if (flap.right >= 0)
      flap.angle = dihedral_angle(a, b, vertex(target_positions, flap.left), vertex(target_positions, flap.right));
    total_length += flap.length;
  }
  for (Flap& flap : flaps_) flap.weight = flap.length / total_length;
}

double EdgeDihedralDistance::value(ConstVec x) const
{
  double sum = 0;
  for (const Flap& flap : flaps_) {
    const Vec3 a = vertex(x, flap.start), b = vertex(x, flap.end);
    const double stretch = 1 - (b - a).norm() / flap.length;
    double bend = 0;
    if (flap.right >= 0) bend = dihedral_angle(a, b, vertex(x, flap.left), vertex(x, flap.right)) - flap.angle;
    sum += flap.weight * (weights_.stretch * stretch * stretch + weights_.bending * bend * bend);
  }
  return sum;
}

void EdgeDihedralDistance::gradient(ConstVec x, Vec& g) const
{
  g.setZero(x.size());
  for (const Flap& flap : flaps_) {
    const Vec3 a = vertex(x, flap.start), b = vertex(x, flap.end);
    const double length = (b - a).norm();
    const Vec3 along =
        -2 * flap.weight * weights_.stretch * (1 - length / flap.length) / (flap.length * length) * (b - a);
    g.segment<3>(3 * flap.start) -= along;
    g.segment<3>(3 * flap.end) += along;
    if (flap.right < 0) continue;
    const Vec3 c = vertex(x, flap.left), d = vertex(x, flap.right);
    const double scale = 2 * flap.weight * weights_.bending * (dihedral_angle(a, b, c, d) - flap.angle);
    const auto bend = dihedral_gradient(a, b, c, d);
    g.segment<3>(3 * flap.start) += scale * bend.segment<3>(0);
    g.segment<3>(3 * flap.end) += scale * bend.segment<3>(3);
    g.segment<3>(3 * flap.left) += scale * bend.segment<3>(6);
    g.segment<3>(3 * flap.right) += scale * bend.segment<3>(9);
  }
}

void EdgeDihedralDistance::gauss_newton_hessian(ConstVec x, SparseMatrix& H) const
{
  if (H.rows() != pattern_.rows() || H.nonZeros() != pattern_.nonZeros()) H = pattern_;
  H.coeffs().setZero();
  const int* column_start = H.outerIndexPtr();
  std::size_t slot = 0;
  for (const Flap& flap : flaps_) {
    const bool has_angle = flap.right >= 0;
    const std::array<int, 4> v{flap.start, flap.end, flap.left, has_angle ? flap.right : flap.left};
    const Vec3 a = vertex(x, v[0]), b = vertex(x, v[1]);
    const Vec3 along = (b - a) / ((b - a).norm() * flap.length);
    Eigen::Matrix<double, 12, 1> stretch = Eigen::Matrix<double, 12, 1>::Zero();
    stretch.segment<3>(0) = -along;
    stretch.segment<3>(3) = along;
    Eigen::Matrix<double, 12, 12> element = 2 * flap.weight * weights_.stretch * stretch * stretch.transpose();
    if (has_angle) {
      const auto bend = dihedral_gradient(a, b, vertex(x, v[2]), vertex(x, v[3]));
      element += 2 * flap.weight * weights_.bending * bend * bend.transpose();
    }
    for (int j = 0; j < 4; ++j)
      for (int i = 0; i < 4; ++i, ++slot)
        for (int q = 0; q < 3; ++q)
          Eigen::Map<Vec3>(H.valuePtr() + column_start[3 * v[static_cast<std::size_t>(j)] + q] + slots_[slot]) +=
              element.block<3, 1>(3 * i, 3 * j + q);
  }
}

}  // namespace softform
