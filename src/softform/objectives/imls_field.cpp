#include "softform/objectives/imls_field.hpp"

#include <cmath>
#include <vector>

#include <Eigen/LU>
#include <nanoflann.hpp>

#include "softform/mesh/distance.hpp"

namespace softform {
namespace {

using KdTree = nanoflann::KDTreeEigenMatrixAdaptor<Positions, 3, nanoflann::metric_L2_Simple>;
constexpr std::size_t leaf_size = 16;

// N and S of d = N / S with their derivatives.
struct Sum {
  double value = 0;
  Vec3 gradient = Vec3::Zero();
  Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();
};

// Adds the kernel at c with normal n: phi to S, n . (x - c) phi to N.
void add_kernel(const Vec3& offset, const Vec3& n, double radius, bool with_hessian, Sum& N, Sum& S)
{
  const double h2 = radius * radius, u = 1 - offset.squaredNorm() / h2, plane = n.dot(offset);
  const double phi = u * u * u * u, slope = -8 * u * u * u / h2;
  const Vec3 gradient = slope * offset;
  S.value += phi;
  S.gradient += gradient;
  N.value += plane * phi;
  N.gradient += phi * n + plane * gradient;
  if (!with_hessian) return;
  const Eigen::Matrix3d hessian =
      slope * Eigen::Matrix3d::Identity() + (48 * u * u / (h2 * h2)) * offset * offset.transpose();
  const Eigen::Matrix3d mixed = n * gradient.transpose();
  S.hessian += hessian;
  N.hessian += mixed + mixed.transpose() + plane * hessian;
}

}  // namespace

struct ImlsField::Tree {
  KdTree index;
  explicit Tree(const Positions& points) : index(3, points, static_cast<int>(leaf_size)) {}
};

ImlsField::ImlsField(Positions centres, Positions normals, double radius)
    : centres_(std::move(centres)), normals_(std::move(normals)), radius_(radius)
{
  tree_ = std::make_unique<Tree>(centres_);
}

// The tree refers to the centres, which move with the object: it is built again.
ImlsField::ImlsField(ImlsField&& other) noexcept
    : centres_(std::move(other.centres_)), normals_(std::move(other.normals_)), radius_(other.radius_)
{
  tree_ = std::make_unique<Tree>(centres_);
}

ImlsField::~ImlsField() = default;

ImlsField::Value ImlsField::nearest(const Vec3& x, Derivatives derivatives) const
{
  Eigen::Index k = 0;
  double squared = 0;
  tree_->index.query(x.data(), 1, &k, &squared);
  const Vec3 offset = x - centres_.row(k).transpose();
  const double distance = offset.norm(), sign = offset.dot(normals_.row(k)) < 0 ? -1 : 1;
  Value value;
  value.distance = sign * distance;
  value.gradient = sign / distance * offset;
  if (derivatives == Derivatives::Second)
    value.hessian = sign / distance * (Eigen::Matrix3d::Identity() - value.gradient * value.gradient.transpose());
  return value;
}

ImlsField::Value ImlsField::evaluate(const Vec3& x, Derivatives derivatives) const
{
  std::vector<std::pair<Eigen::Index, double>> matches;
  tree_->index.index->radiusSearch(x.data(), radius_ * radius_, matches, nanoflann::SearchParams(0, 0, false));
  const bool with_hessian = derivatives == Derivatives::Second;
  Sum N, S;
  for (const auto& [k, squared] : matches)
    add_kernel(x - centres_.row(k).transpose(), normals_.row(k), radius_, with_hessian, N, S);
  // Far out a single kernel fades away: its plane is where the field goes on as the distance to its centre.
  if (!(S.value > 1e-12)) return nearest(x, derivatives);
  Value value;
  value.distance = N.value / S.value;
  value.gradient = (N.gradient - value.distance * S.gradient) / S.value;
  if (with_hessian) {
    const Eigen::Matrix3d mixed = value.gradient * S.gradient.transpose();
    value.hessian = (N.hessian - value.distance * S.hessian - mixed - mixed.transpose()) / S.value;
  }
  return value;
}

ImlsField imls_field(const TriangleMesh& surface, int count)
{
  const Positions points = sample_surface(surface, count);
  const Positions vertex_normal = vertex_normals(flatten(surface.vertices), surface.triangles);
  const std::vector<ClosestPoint> on_surface = SurfaceDistance(surface).closest_points(points);
  Positions normals(points.rows(), 3);
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    const auto triangle = surface.triangles.row(on_surface[std::size_t(i)].triangle);
    Eigen::Matrix3d corners, corner_normals;
    for (int k = 0; k < 3; ++k) {
      corners.col(k) = surface.vertices.row(triangle[k]);
      corner_normals.col(k) = vertex_normal.row(triangle[k]);
    }
    // Barycentric coordinates, in the plane spanned by two edges and their normal.
    const Vec3 u = corners.col(1) - corners.col(0), v = corners.col(2) - corners.col(0);
    const Vec3 p = points.row(i).transpose() - corners.col(0);
    const Eigen::Matrix2d gram{{u.dot(u), u.dot(v)}, {u.dot(v), v.dot(v)}};
    const Eigen::Vector2d b = gram.inverse() * Eigen::Vector2d(u.dot(p), v.dot(p));
    normals.row(i) = (corner_normals * Vec3(1 - b.sum(), b[0], b[1])).normalized();
  }
  const double spacing = std::sqrt(surface_area(flatten(surface.vertices), surface.triangles) / count);
  return {points, normals, 3 * spacing};
}

}  // namespace softform
