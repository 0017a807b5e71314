#include "softform/objectives/edge_dihedral.hpp"

#include <array>
#include <cmath>

#include <Eigen/Geometry>

#include "softform/core/dual.hpp"

namespace softform {

// Normals n1 = (b - a) x (c - a) and n2 = (d - a) x (b - a), both outwards.
double dihedral_angle(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
{
  const Vec3 e = b - a;
  const Vec3 n1 = e.cross(c - a);
  const Vec3 n2 = (d - a).cross(e);
  return std::atan2(n1.cross(n2).dot(e) / e.norm(), n1.dot(n2));
}

namespace {

template <class Scalar>
using Vec12 = Eigen::Matrix<Scalar, 12, 1>;

// Grinspun et al. 2003; the angle grows when c or d moves against its normal.
template <class Scalar>
Vec12<Scalar> dihedral_gradient_at(const Vec12<Scalar>& corners)
{
  using V = Eigen::Matrix<Scalar, 3, 1>;
  const V a = corners.template segment<3>(0), e = corners.template segment<3>(3) - a;
  const V to_c = corners.template segment<3>(6) - a, to_d = corners.template segment<3>(9) - a;
  const Scalar length = e.norm();
  const V n1 = e.cross(to_c), n2 = to_d.cross(e);
  const V grad_c = n1 * (-length / n1.squaredNorm());
  const V grad_d = n2 * (-length / n2.squaredNorm());
  // Barycentric places of c and d along the edge give the share of each end.
  const Scalar s_c = to_c.dot(e) / (length * length), s_d = to_d.dot(e) / (length * length);
  const Scalar one(1);
  Vec12<Scalar> gradient;
  gradient << -(grad_c * (one - s_c)) - grad_d * (one - s_d), -(grad_c * s_c) - grad_d * s_d, grad_c, grad_d;
  return gradient;
}

Vec12<double> stacked(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
{
  Vec12<double> corners;
  corners << a, b, c, d;
  return corners;
}

}  // namespace

Eigen::Matrix<double, 12, 1> dihedral_gradient(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
{
  return dihedral_gradient_at(stacked(a, b, c, d));
}

Eigen::Matrix<double, 12, 12> dihedral_hessian(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
{
  using Variable = DualNumber<12>;
  Vec12<Variable> corners = stacked(a, b, c, d).cast<Variable>();
  for (int i = 0; i < 12; ++i) corners[i] = Variable::variable(corners[i].value(), i);
  const Vec12<Variable> gradient = dihedral_gradient_at(corners);
  Eigen::Matrix<double, 12, 12> hessian;
  for (int i = 0; i < 12; ++i)
    for (int j = 0; j < 12; ++j) hessian(i, j) = gradient[i].derivative(j);
  return hessian;
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

template <class ElementOf>
void EdgeDihedralDistance::assemble(ConstVec x, const ElementOf& element_of, SparseMatrix& H) const
{
  if (H.rows() != pattern_.rows() || H.nonZeros() != pattern_.nonZeros()) H = pattern_;
  H.coeffs().setZero();
  const int* column_start = H.outerIndexPtr();
  std::size_t slot = 0;
  for (const Flap& flap : flaps_) {
    const std::array<int, 4> v{flap.start, flap.end, flap.left, flap.right >= 0 ? flap.right : flap.left};
    const Mat12 element = element_of(flap, {vertex(x, v[0]), vertex(x, v[1]), vertex(x, v[2]), vertex(x, v[3])});
    for (int j = 0; j < 4; ++j)
      for (int i = 0; i < 4; ++i, ++slot)
        for (int q = 0; q < 3; ++q)
          Eigen::Map<Vec3>(H.valuePtr() + column_start[3 * v[static_cast<std::size_t>(j)] + q] + slots_[slot]) +=
              element.block<3, 1>(3 * i, 3 * j + q);
  }
}

EdgeDihedralDistance::Mat12 EdgeDihedralDistance::gauss_newton_element(const Flap& flap,
                                                                       const std::array<Vec3, 4>& corners) const
{
  const auto& [a, b, c, d] = corners;
  const Vec3 along = (b - a) / ((b - a).norm() * flap.length);
  Vec12<double> stretch = Vec12<double>::Zero();
  stretch.segment<3>(0) = -along;
  stretch.segment<3>(3) = along;
  Mat12 element = 2 * flap.weight * weights_.stretch * stretch * stretch.transpose();
  if (flap.right >= 0) {
    const Vec12<double> bend = dihedral_gradient(a, b, c, d);
    element += 2 * flap.weight * weights_.bending * bend * bend.transpose();
  }
  return element;
}

// What Gauss-Newton leaves out: the residuals times the second derivatives of length and angle.
EdgeDihedralDistance::Mat12 EdgeDihedralDistance::curvature_element(const Flap& flap,
                                                                    const std::array<Vec3, 4>& corners) const
{
  const auto& [a, b, c, d] = corners;
  const double length = (b - a).norm();
  const Vec3 u = (b - a) / length;
  const Eigen::Matrix3d length_hessian = (Eigen::Matrix3d::Identity() - u * u.transpose()) / length;
  const double stretch = 2 * flap.weight * weights_.stretch * (length / flap.length - 1) / flap.length;
  Mat12 element = Mat12::Zero();
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j) element.block<3, 3>(3 * i, 3 * j) = (i == j ? stretch : -stretch) * length_hessian;
  if (flap.right >= 0) {
    const double bend = 2 * flap.weight * weights_.bending * (dihedral_angle(a, b, c, d) - flap.angle);
    element += bend * dihedral_hessian(a, b, c, d);
  }
  return element;
}

void EdgeDihedralDistance::gauss_newton_hessian(ConstVec x, SparseMatrix& H) const
{
  const auto element_of = [&](const Flap& flap, const std::array<Vec3, 4>& corners) {
    return gauss_newton_element(flap, corners);
  };
  assemble(x, element_of, H);
}

bool EdgeDihedralDistance::hessian(ConstVec x, SparseMatrix& H) const
{
  const auto element_of = [&](const Flap& flap, const std::array<Vec3, 4>& corners) -> Mat12 {
    return gauss_newton_element(flap, corners) + curvature_element(flap, corners);
  };
  assemble(x, element_of, H);
  return true;
}

}  // namespace softform
