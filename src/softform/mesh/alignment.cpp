#include "softform/mesh/alignment.hpp"

#include <utility>
#include <vector>

#include <Eigen/Geometry>

namespace softform {

Positions RigidMotion::operator()(const Positions& points) const
{
  return (points * rotation.transpose()).rowwise() + translation.transpose();
}

RigidMotion rigid_alignment(const Positions& source, const Positions& target)
{
  // Dynamic sizes: with three fixed rows gcc 12 sees an overrun in Eigen's AVX-512 code that is not there.
  const Eigen::MatrixXd from = source.transpose(), to = target.transpose();
  const Eigen::MatrixXd motion = Eigen::umeyama(from, to, false);
  return {motion.topLeftCorner(3, 3), motion.topRightCorner(3, 1)};
}

namespace {

/// The motion to try next, from the distances d_i = n_i . (x_i - q_i) of points x_i to their closest points q_i: with a
/// small rotation w and translation t,  d_i + n_i . (w cross x_i + t)  in the least squares.
RigidMotion gauss_newton_step(const Positions& points, const std::vector<ClosestPoint>& closest, double extent)
{
  Eigen::Matrix<double, 6, 6> H = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Matrix<double, 6, 1> g = Eigen::Matrix<double, 6, 1>::Zero();
  const Vec3 centre = points.colwise().mean();
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    const ClosestPoint& c = closest[static_cast<std::size_t>(i)];
    const Vec3 x = points.row(i);
    // On the surface the distance has no direction but the surface's normal.
    const Vec3 n = c.distance > 1e-9 * extent ? Vec3((x - c.position) / c.distance) : c.normal;
    Eigen::Matrix<double, 6, 1> J;
    J << (x - centre).cross(n) / extent, n;
    H += J * J.transpose();
    g += J * n.dot(x - c.position);
  }
  // A sphere may turn freely: the shift keeps the noise of its triangles from turning it.
  H.diagonal().array() += 1e-3 * H.trace();
  const Eigen::Matrix<double, 6, 1> step = -H.ldlt().solve(g);
  const Vec3 w = step.head<3>() / extent;
  const Eigen::Matrix3d rotation =
      w.norm() > 0 ? Eigen::AngleAxisd(w.norm(), w.normalized()).toRotationMatrix() : Eigen::Matrix3d::Identity();
  return {rotation, centre - rotation * centre + step.tail<3>()};
}

double mean_square(const std::vector<ClosestPoint>& closest)
{
  double sum = 0;
  for (const ClosestPoint& c : closest) sum += c.distance * c.distance;
  return sum / static_cast<double>(closest.size());
}

Positions positions_of(const std::vector<ClosestPoint>& closest)
{
  Positions positions(static_cast<Eigen::Index>(closest.size()), 3);
  for (std::size_t i = 0; i < closest.size(); ++i) positions.row(static_cast<Eigen::Index>(i)) = closest[i].position;
  return positions;
}

}  // namespace

RigidMotion rigid_alignment(const Positions& source, const SurfaceDistance& target)
{
  const double extent = (source.colwise().maxCoeff() - source.colwise().minCoeff()).norm();
  RigidMotion best;
  std::vector<ClosestPoint> closest = target.closest_points(source);
  for (int k = 0; k < 100; ++k) {
    const Positions points = best(source);
    const double before = mean_square(closest);
    const RigidMotion step = gauss_newton_step(points, closest, extent);
    RigidMotion next{step.rotation * best.rotation, step.rotation * best.translation + step.translation};
    std::vector<ClosestPoint> next_closest = target.closest_points(next(source));
    if (!(mean_square(next_closest) < before)) {
      next = rigid_alignment(source, positions_of(closest));
      next_closest = target.closest_points(next(source));
    }
    const double after = mean_square(next_closest);
    if (!(after < before)) break;
    best = next;
    closest = std::move(next_closest);
    if (before - after < 1e-6 * before) break;
  }
  return best;
}

}  // namespace softform
