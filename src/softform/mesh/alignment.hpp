#pragma once

#include "softform/core/types.hpp"
#include "softform/mesh/distance.hpp"

namespace softform {

/// x -> rotation x + translation; no scale, no reflection.
struct RigidMotion {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Vec3 translation = Vec3::Zero();  ///< [m]

  Positions operator()(const Positions& points) const;
};

/// The motion that brings `source` closest to `target` in the mean square, row by row (Umeyama 1991).
/// Precondition: as many rows in both, at least 3.
RigidMotion rigid_alignment(const Positions& source, const Positions& target);

/// The motion that brings points closest to a surface in the mean square of their distances: Gauss-Newton from the
/// identity; where its step does not help, closest points and rigid_alignment, which always do. Ends when the mean
/// square falls by less than 1e-6 of itself, or after 100 steps. Local: give it points that are roughly in place.
RigidMotion rigid_alignment(const Positions& source, const SurfaceDistance& target);

}  // namespace softform
