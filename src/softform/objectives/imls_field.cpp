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

// The weight of kernels on a surface, in its middle, is some 6.
constexpr double fading_weight = 0.3;

// A function of x with its derivatives.
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

// N += w D and S += w, w the weight of the wider kernels' field D.
void add_wider(const ImlsField::Value& D, bool with_hessian, Sum& N, Sum& S)
{
  const double u = 1 - S.value / fading_weight, w = u * u * u * u, slope = -4 * u * u * u / fading_weight;
  const Vec3 gradient = slope * S.gradient;
  if (with_hessian) {
    const Eigen::Matrix3d hessian =
        slope * S.hessian + (12 * u * u / (fading_weight * fading_weight)) * S.gradient * S.gradient.transpose();
    const Eigen::Matrix3d mixed = gradient * D.gradient.transpose();
    N.hessian += D.distance * hessian + mixed + mixed.transpose() + w * D.hessian;
    S.hessian += hessian;
  }
  N.gradient += D.distance * gradient + w * D.gradient;
  N.value += w * D.distance;
  S.gradient += gradient;
  S.value += w;
}

ImlsField::Value quotient(const Sum& N, const Sum& S, bool with_hessian)
{
  ImlsField::Value value;
  value.distance = N.value / S.value;
  value.gradient = (N.gradient - value.distance * S.gradient) / S.value;
  if (with_hessian) {
    const Eigen::Matrix3d mixed = value.gradient * S.gradient.transpose();
    value.hessian = (N.hessian - value.distance * S.hessian - mixed - mixed.transpose()) / S.value;
  }
  return value;
}

// Centres spread evenly, with normals interpolated between those of the vertices.
ImlsKernels kernels_on(const TriangleMesh& surface, const SurfaceDistance& distance, const Positions& vertex_normal,
                       int count, double radius)
{
  const Positions points = sample_surface(surface, count);
  const std::vector<ClosestPoint> on_surface = distance.closest_points(points);
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
  return {points, normals, radius};
}

}  // namespace

struct ImlsField::Level {
  ImlsKernels kernels;
  KdTree index;
  explicit Level(ImlsKernels given) : kernels(std::move(given)), index(3, kernels.centres, static_cast<int>(leaf_size))
  {}
};

ImlsField::ImlsField(std::vector<ImlsKernels> levels)
{
  for (ImlsKernels& kernels : levels) levels_.push_back(std::make_unique<const Level>(std::move(kernels)));
}

ImlsField::ImlsField(ImlsField&&) noexcept = default;
ImlsField::~ImlsField() = default;

double ImlsField::radius() const { return levels_.front()->kernels.radius; }

ImlsField::Value ImlsField::nearest(const Vec3& x, Derivatives derivatives) const
{
  const Level& finest = *levels_.front();
  Eigen::Index k = 0;
  double squared = 0;
  finest.index.query(x.data(), 1, &k, &squared);
  const Vec3 offset = x - finest.kernels.centres.row(k).transpose();
  const double distance = offset.norm(), sign = offset.dot(finest.kernels.normals.row(k)) < 0 ? -1 : 1;
  Value value;
  value.distance = sign * distance;
  value.gradient = sign / distance * offset;
  if (derivatives == Derivatives::Second)
    value.hessian = sign / distance * (Eigen::Matrix3d::Identity() - value.gradient * value.gradient.transpose());
  return value;
}

ImlsField::Value ImlsField::evaluate(const Vec3& x, Derivatives derivatives) const
{
  return evaluate(x, derivatives, 0);
}

ImlsField::Value ImlsField::evaluate(const Vec3& x, Derivatives derivatives, std::size_t level) const
{
  if (level == levels_.size()) return nearest(x, derivatives);
  const auto& [centres, normals, radius] = levels_[level]->kernels;
  std::vector<std::pair<Eigen::Index, double>> matches;
  levels_[level]->index.index->radiusSearch(x.data(), radius * radius, matches, nanoflann::SearchParams(0, 0, false));
  const bool with_hessian = derivatives == Derivatives::Second;
  Sum N, S;
  for (const auto& [k, squared] : matches)
    add_kernel(x - centres.row(k).transpose(), normals.row(k), radius, with_hessian, N, S);
  if (S.value < fading_weight) add_wider(evaluate(x, derivatives, level + 1), with_hessian, N, S);
  return quotient(N, S, with_hessian);
}

ImlsField imls_field(const TriangleMesh& surface, int count)
{
  constexpr int fewest_centres = 40;
  const Vec x = flatten(surface.vertices);
  const double area = surface_area(x, surface.triangles);
  const SurfaceDistance distance(surface);
  const Positions vertex_normal = vertex_normals(x, surface.triangles);
  std::vector<ImlsKernels> levels;
  for (; levels.empty() || count >= fewest_centres; count /= 4)
    levels.push_back(kernels_on(surface, distance, vertex_normal, count, 3 * std::sqrt(area / count)));
  return ImlsField(std::move(levels));
}

}  // namespace softform
