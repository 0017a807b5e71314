#include "softform/mesh/rbf_implicit.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <fmt/format.h>
#include <nanoflann.hpp>

#include "softform/core/error.hpp"

namespace softform {
namespace {

using Tree = nanoflann::KDTreeEigenMatrixAdaptor<Positions, 3, nanoflann::metric_L2_Simple>;

void check(const Positions& points, const RbfOptions& options)
{
  const int least = std::max(options.centres / 3, options.neighbours);
  if (points.rows() < least)
    throw InputError(fmt::format("a scan of {} points: it needs {} or more, or fewer centres", points.rows(), least));
  for (Eigen::Index i = 0; i < points.rows(); ++i)
    if (!points.row(i).allFinite()) throw InputError(fmt::format("point {} of the scan is not finite: drop it", i));
}

// Points far from each other, each the farthest from those before it.
std::vector<Eigen::Index> spread_points(const Positions& points, int count)
{
  std::vector<Eigen::Index> chosen{0};
  Vec distance = (points.rowwise() - points.row(0)).rowwise().squaredNorm();
  while (static_cast<int>(chosen.size()) < count) {
    Eigen::Index farthest;
    distance.maxCoeff(&farthest);
    chosen.push_back(farthest);
    distance = distance.cwiseMin((points.rowwise() - points.row(farthest)).rowwise().squaredNorm());
  }
  return chosen;
}

// The direction of least spread of a point's neighbours, pointing away from `inside`.
Vec3 normal_at(const Positions& points, const Tree& tree, Eigen::Index i, const Vec3& inside, int neighbours)
{
  std::vector<Eigen::Index> near(static_cast<std::size_t>(neighbours));
  std::vector<double> squared_distances(near.size());
  const Vec3 point = points.row(i);
  tree.index->knnSearch(point.data(), near.size(), near.data(), squared_distances.data());
  const Positions cluster = points(near, Eigen::all);
  const Positions centred = cluster.rowwise() - cluster.colwise().mean();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(centred.transpose() * centred);
  const Vec3 normal = axes.eigenvectors().col(0);
  return normal.dot(point - inside) < 0 ? Vec3(-normal) : normal;
}

}  // namespace

RbfImplicit::RbfImplicit(const Positions& points, const Vec3& inside, const RbfOptions& options, const Positions& edge)
{
  check(points, options);
  const Tree tree(3, std::cref(points), 10);
  const std::vector<Eigen::Index> chosen = spread_points(points, options.centres / 3);
  Positions normals(static_cast<Eigen::Index>(chosen.size()), 3);
  for (std::size_t k = 0; k < chosen.size(); ++k)
    normals.row(static_cast<Eigen::Index>(k)) = normal_at(points, tree, chosen[k], inside, options.neighbours);
  fit(points(chosen, Eigen::all), normals, edge, options);
}

RbfImplicit RbfImplicit::from_normals(const Positions& points, const Positions& normals, const RbfOptions& options)
{
  if (!points.allFinite() || !normals.allFinite())
    throw InputError("a point of the surface or its normal is not finite: repair it");
  const auto chosen = spread_points(points, std::min(options.centres / 3, static_cast<int>(points.rows())));
  RbfImplicit implicit;
  implicit.fit(points(chosen, Eigen::all), normals(chosen, Eigen::all), {}, options);
  return implicit;
}

void RbfImplicit::fit(const Positions& points, const Positions& normals, const Positions& edge,
                      const RbfOptions& options)
{
  const Eigen::Index n = 3 * points.rows() + edge.rows();
  unit_ = (points.colwise().maxCoeff() - points.colwise().minCoeff()).norm();
  centres_.resize(3, n);
  Vec values = Vec::Zero(n);
  centres_.rightCols(edge.rows()) = edge.transpose() / unit_;
  Eigen::Index column = 0;
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    for (const double side : {0.0, 1.0, -1.0}) {
      values[column] = side * options.offset;
      centres_.col(column++) = (points.row(i) + side * options.offset * normals.row(i)).transpose() / unit_;
    }
  }
  solve(std::move(values), options.smoothing);
}

// [K + rho I, P; P^t, 0] (w; c) = (values; 0). r^3 is conditionally positive definite of order 2: for weights
// orthogonal to the linear polynomials P, K + rho I is positive definite for rho >= 0, and rho weighs the energy of s
// against its residuals. In the basis Q of P = Q R, the last n - 4 columns span those weights.
void RbfImplicit::solve(Vec values, double smoothing)
{
  const Eigen::Index n = values.size();
  Eigen::MatrixXd K(n, n), P(n, 4);
  for (Eigen::Index j = 0; j < n; ++j)
    K.col(j) = (centres_.colwise() - centres_.col(j)).colwise().norm().array().cube();
  K.diagonal().array() += smoothing;
  P << Vec::Ones(n), centres_.transpose();
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(P);
  const auto Q = qr.householderQ();
  K.applyOnTheLeft(Q.transpose());
  K.applyOnTheRight(Q);
  values.applyOnTheLeft(Q.transpose());
  weights_.setZero(n);
  weights_.tail(n - 4) = K.bottomRightCorner(n - 4, n - 4).llt().solve(values.tail(n - 4));
  const Eigen::Vector4d remainder = values.head<4>() - K.topRightCorner(4, n - 4) * weights_.tail(n - 4);
  polynomial_ = qr.matrixQR().topRows<4>().triangularView<Eigen::Upper>().solve(remainder);
  weights_.applyOnTheLeft(Q);
}

double RbfImplicit::value(const Vec3& x, Vec3& gradient) const
{
  const Vec3 y = x / unit_;
  const Eigen::Matrix3Xd offsets = (-centres_).colwise() + y;
  const Eigen::ArrayXd r = offsets.colwise().norm().transpose();
  const Eigen::ArrayXd weighted = weights_.array() * r;
  gradient = (3 * (offsets * weighted.matrix()) + polynomial_.tail<3>()) / unit_;
  return (weighted * r.square()).sum() + polynomial_[0] + polynomial_.tail<3>().dot(y);
}

double RbfImplicit::value(const Vec3& x) const
{
  Vec3 gradient;
  return value(x, gradient);
}

Vec3 RbfImplicit::project(Vec3 x) const
{
  constexpr int iterations = 3;  // quadratic, and s is close to the distance
  Vec3 gradient;
  for (int k = 0; k < iterations; ++k) {
    const double s = value(x, gradient);
    x -= s / gradient.squaredNorm() * gradient;
  }
  return x;
}

}  // namespace softform
