#include "softform/fem/enclosed_volume.hpp"

#include <utility>

#include <Eigen/Geometry>

namespace softform {
namespace {

Eigen::Matrix3d cross_matrix(const Vec3& a)
{
  Eigen::Matrix3d A;
  A << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return A;
}

}  // namespace

EnclosedVolume::EnclosedVolume(const Triangles& triangles, int vertex_count)
    : EnclosedVolume(triangles, vertex_count, std::vector<char>(static_cast<std::size_t>(triangles.rows()), 1))
{}

EnclosedVolume::EnclosedVolume(Triangles triangles, int vertex_count, std::vector<char> is_skin)
    : triangles_(std::move(triangles)),
      vertex_count_(vertex_count),
      is_skin_(std::move(is_skin)),
      pattern_(triangles_, vertex_count)
{}

double EnclosedVolume::value(ConstVec x) const
{
  double volume = 0;
  for (int t = 0; t < triangles_.rows(); ++t) {
    if (!is_skin_[std::size_t(t)]) continue;
    const Vec3 a = vertex(x, triangles_(t, 0)), b = vertex(x, triangles_(t, 1)), c = vertex(x, triangles_(t, 2));
    volume += a.dot(b.cross(c)) / 6;
  }
  return volume;
}

void EnclosedVolume::gradient(ConstVec x, Vec& g) const
{
  g.setZero(3 * vertex_count_);
  for (int t = 0; t < triangles_.rows(); ++t) {
    if (!is_skin_[std::size_t(t)]) continue;
    const int i = triangles_(t, 0), j = triangles_(t, 1), k = triangles_(t, 2);
    const Vec3 a = vertex(x, i), b = vertex(x, j), c = vertex(x, k);
    // The sum over a closed surface of d(a . b x c)/6 equals that of a third of the area vectors.
    const Vec3 third_of_area = (b - a).cross(c - a) / 6;
    g.segment<3>(3 * i) += third_of_area;
    g.segment<3>(3 * j) += third_of_area;
    g.segment<3>(3 * k) += third_of_area;
  }
}

// d2(a . b x c)/6: the block of two vertices is the cross matrix of the third.
void EnclosedVolume::add_hessian(ConstVec x, double scale, SparseMatrix& H) const
{
  const auto block_of = [&](int t, int row, int column) -> Eigen::Matrix3d {
    if (row == column || !is_skin_[std::size_t(t)]) return Eigen::Matrix3d::Zero();
    const bool is_next = column == (row + 1) % 3;
    const int third = 3 - row - column;
    return cross_matrix((is_next ? -scale : scale) / 6 * vertex(x, triangles_(t, third)));
  };
  pattern_.add(block_of, H);
}

}  // namespace softform
