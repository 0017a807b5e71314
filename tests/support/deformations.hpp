#pragma once

#include <cmath>

#include "softform/mesh/triangle_mesh.hpp"

/// Deterministic directions and shapes without symmetry, for derivative tests.
namespace softform::testing {

/// A smooth-less, zero-mean-like direction (size) of entries in [-1, 1].
inline Vec wiggle(int size, int seed)
{
  Vec v(size);
  for (int i = 0; i < size; ++i) v[i] = std::sin(1.7 * i * seed + 0.3 * seed + 0.01 * i * i);
  return v;
}

/// The mesh stretched by 1.6, 1.9 and 2.3 along the axes and bent a little: every triangle has two different stretches.
inline Vec deformed(const TriangleMesh& mesh)
{
  Positions x = mesh.vertices;
  const double size = x.cwiseAbs().maxCoeff();
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    const Eigen::RowVector3d X = mesh.vertices.row(i);
    x.row(i) << 1.6 * X.x() + 0.2 * X.y() * X.z() / size, 1.9 * X.y() + 0.1 * X.x() * X.x() / size,
        2.3 * X.z() - 0.2 * X.x();
  }
  return flatten(x);
}

}  // namespace softform::testing

#define EXPECT_SLOPE(check)                           \
  do {                                                \
    const auto slope_check = (check);                 \
    EXPECT_TRUE(slope_check.passes()) << slope_check; \
  } while (false)
