#include "softform/fem/enclosed_volume.hpp"

#include <utility>

#include <Eigen/Geometry>

#include "softform/core/parallel.hpp"
#include "softform/mesh/triangle_mesh.hpp"

namespace softform {
namespace {

Eigen::Matrix3d cross_matrix(const Vec3& a)
{
  Eigen::Matrix3d A;
  A << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return A;
}

}  // namespace

EnclosedVolume::EnclosedVolume(Triangles triangles, int vertex_count)
    : triangles_(std::move(triangles)),
      vertex_count_(vertex_count),
      pattern_(triangles_, vertex_count),
      element_matrices_(static_cast<std::size_t>(triangles_.rows()) * 81)
{}

double EnclosedVolume::value(ConstVec x) const { return enclosed_volume(x, triangles_); }

void EnclosedVolume::gradient(ConstVec x, Vec& g) const
{
  g.setZero(3 * vertex_count_);
  for (int t = 0; t < triangles_.rows(); ++t) {
    const int i = triangles_(t, 0), j = triangles_(t, 1), k = triangles_(t, 2);
    const Vec3 a = vertex(x, i), b = vertex(x, j), c = vertex(x, k);
    // The sum over a closed surface of d(a . b x c)/6 equals that of a third of the area vectors.
    const Vec3 third_of_area = (b - a).cross(c - a) / 6;
    g.segment<3>(3 * i) += third_of_area;
    g.segment<3>(3 * j) += third_of_area;
    g.segment<3>(3 * k) += third_of_area;
  }
}

void EnclosedVolume::hessian(ConstVec x, SparseMatrix& H) const
{
  const int count = static_cast<int>(triangles_.rows());
  parallel_for(count, [&](int t) {
    Eigen::Map<Eigen::Matrix<double, 9, 9>> element(&element_matrices_[static_cast<std::size_t>(t) * 81]);
    element.setZero();
    for (int k = 0; k < 3; ++k) {
      // d2(a . b x c)/6: the block of two vertices is the cross matrix of the third.
      const Eigen::Matrix3d block = cross_matrix(vertex(x, triangles_(t, (k + 2) % 3))) / 6;
      const int r = k, c = (k + 1) % 3;
      element.block<3, 3>(3 * r, 3 * c) = -block;
      element.block<3, 3>(3 * c, 3 * r) = block;
    }
  });
  pattern_.assemble(element_matrices_, H);
}

}  // namespace softform
