#include "softform/mesh/alignment.hpp"

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

RigidMotion rigid_alignment(const Positions& source, const SurfaceDistance& target)
{
  const double extent = (source.colwise().maxCoeff() - source.colwise().minCoeff()).norm();
  RigidMotion motion;
  Positions moved = source;
  for (int step = 0; step < 100; ++step) {
    motion = rigid_alignment(source, target.closest_points(moved));
    const Positions next = motion(source);
    const double largest_move = (next - moved).rowwise().norm().maxCoeff();
    moved = next;
    if (largest_move <= 1e-6 * extent) break;
  }
  return motion;
}

}  // namespace softform
