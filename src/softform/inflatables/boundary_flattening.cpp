#include "softform/inflatables/boundary_flattening.hpp"

#include <cmath>
#include <numbers>
#include <utility>

#include <Eigen/Geometry>

#include "softform/optimizers/gradient_projection.hpp"

namespace softform {
namespace {

using Vec2 = Eigen::Vector2d;

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

/// The gradient of the direction angle of v.
Vec2 angle_gradient(const Vec2& v) { return Vec2(-v.y(), v.x()) / v.squaredNorm(); }

Vec2 point(ConstVec z, Eigen::Index i) { return z.segment<2>(2 * i); }

}  // namespace

BoundaryShape boundary_shape(const TriangleMesh& mesh, const std::vector<int>& loop)
{
  const auto b = static_cast<Eigen::Index>(loop.size());
  BoundaryShape shape{Vec(b), Vec(b)};
  Vec angle_at = Vec::Zero(mesh.vertex_count());
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const Vec3 apex = mesh.vertices.row(mesh.triangles(t, k));
      const Vec3 u = mesh.vertices.row(mesh.triangles(t, (k + 1) % 3)).transpose() - apex;
      const Vec3 v = mesh.vertices.row(mesh.triangles(t, (k + 2) % 3)).transpose() - apex;
      angle_at[mesh.triangles(t, k)] += std::atan2(u.cross(v).norm(), u.dot(v));
    }
  }
  for (Eigen::Index j = 0; j < b; ++j) {
    const int v = loop[static_cast<std::size_t>(j)], next = loop[static_cast<std::size_t>((j + 1) % b)];
    shape.lengths[j] = (mesh.vertices.row(next) - mesh.vertices.row(v)).norm();
    shape.angles[j] = angle_at[v];
  }
  return shape;
}

BoundaryFlattening::BoundaryFlattening(BoundaryShape shape)
    : shape_(std::move(shape)), mean_lengths_(shape_.lengths.size())
{
  const Eigen::Index b = shape_.lengths.size();
  for (Eigen::Index j = 0; j < b; ++j) mean_lengths_[j] = 0.5 * (shape_.lengths[j] + shape_.lengths[(j + b - 1) % b]);
}

Vec BoundaryFlattening::initial_point() const
{
  const Eigen::Index b = shape_.lengths.size();
  const double surplus = 2 * std::numbers::pi - (std::numbers::pi - shape_.angles.array()).sum();
  const double length = shape_.lengths.sum();
  Vec z(2 * b);
  Vec2 q = Vec2::Zero();
  double direction = 0;
  for (Eigen::Index j = 0; j < b; ++j) {
    z.segment<2>(2 * j) = q;
    q += shape_.lengths[j] * Vec2(std::cos(direction), std::sin(direction));
    const Eigen::Index next = (j + 1) % b;
    direction += std::numbers::pi - shape_.angles[next] + surplus * mean_lengths_[next] / length;
  }
  double so_far = 0;
  for (Eigen::Index j = 0; j < b; ++j) {
    z.segment<2>(2 * j) -= so_far / length * q;
    so_far += shape_.lengths[j];
  }
  return z;
}

void BoundaryFlattening::residuals(ConstVec z, Vec& r) const
{
  const Eigen::Index b = shape_.lengths.size();
  r.resize(2 * b);
  for (Eigen::Index j = 0; j < b; ++j) {
    const Vec2 q = point(z, j), to_next = point(z, (j + 1) % b) - q, to_last = point(z, (j + b - 1) % b) - q;
    const double l = shape_.lengths[j];
    r[j] = (to_next.norm() - l) / std::sqrt(l);
    const double angle = std::atan2(cross(to_next, to_last), to_next.dot(to_last));
    r[b + j] = std::sqrt(mean_lengths_[j]) * std::remainder(angle - shape_.angles[j], 2 * std::numbers::pi);
  }
}

void BoundaryFlattening::residual_jacobian(ConstVec z, SparseMatrix& R) const
{
  const Eigen::Index b = shape_.lengths.size();
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(static_cast<std::size_t>(10 * b));
  const auto add = [&](Eigen::Index row, Eigen::Index j, const Vec2& gradient) {
    for (Eigen::Index k = 0; k < 2; ++k) entries.emplace_back(row, 2 * j + k, gradient[k]);
  };
  for (Eigen::Index j = 0; j < b; ++j) {
    const Eigen::Index next = (j + 1) % b, last = (j + b - 1) % b;
    const Vec2 q = point(z, j), to_next = point(z, next) - q, to_last = point(z, last) - q;
    const Vec2 along = to_next.normalized() / std::sqrt(shape_.lengths[j]);
    add(j, next, along);
    add(j, j, -along);
    const double m = std::sqrt(mean_lengths_[j]);
    const Vec2 of_last = m * angle_gradient(to_last), of_next = m * angle_gradient(to_next);
    add(b + j, last, of_last);
    add(b + j, next, -of_next);
    add(b + j, j, of_next - of_last);
  }
  R.resize(2 * b, 2 * b);
  R.setFromTriplets(entries.begin(), entries.end());
}

FlatPositions flat_boundary(const BoundaryShape& shape)
{
  ProjectedNewtonOptions options;
  options.hessian = HessianModel::GaussNewton;
  StopCriteria stop;
  stop.relative_decrease = 1e-9;
  const Solution solution = GradientProjection(options).minimize(BoundaryFlattening(shape), stop);
  return Eigen::Map<const FlatPositions>(solution.z.data(), shape.lengths.size(), 2);
}

}  // namespace softform
