#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>

/// The few types that every folder shares. SI units throughout: metres, newtons, pascals, seconds.
namespace softform {

using Vec = Eigen::VectorXd;
using Vec3 = Eigen::Vector3d;
using ConstVec = Eigen::Ref<const Vec>;
using SparseMatrix = Eigen::SparseMatrix<double>;

/// One row a vertex, (n, 3) [m]. Row-major, so that the flat view is x0 y0 z0 x1 y1 z1 ...
using Positions = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
/// One row a triangle, (m, 3): vertex indices, counter-clockwise seen from outside.
using Triangles = Eigen::Matrix<int, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// The flat state vector (3n) of vertex positions (n, 3).
inline Vec flatten(const Positions& positions) { return Eigen::Map<const Vec>(positions.data(), positions.size()); }

/// The positions (n, 3) of a flat state vector (3n).
inline Positions unflatten(ConstVec x) { return Eigen::Map<const Positions>(x.data(), x.size() / 3, 3); }

/// Vertex i of a flat state vector.
inline auto vertex(ConstVec x, int i) { return x.segment<3>(3 * Eigen::Index(i)); }

}  // namespace softform
