#pragma once

#include "softform/core/types.hpp"

namespace softform {

/// An orthonormal basis (3n, 6) of the infinitesimal rigid motions of nodes x (3n): three translations and three
/// rotations about their centroid. Precondition: the nodes are not on a line.
Eigen::Matrix<double, Eigen::Dynamic, 6> rigid_motions(ConstVec x);

/// b (3n) without its part in the rigid motions of x.
Vec without_rigid_motions(const Vec& b, ConstVec x);

}  // namespace softform
