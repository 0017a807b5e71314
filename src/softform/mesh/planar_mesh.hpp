#pragma once

#include "softform/core/types.hpp"

namespace softform {

/// One row a vertex, (n, 2) [m]. Row-major, so that the flat view is x0 y0 x1 y1 ...
using PlanarPositions = Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>;

/// A triangulation of a part of the plane, counter-clockwise.
struct PlanarMesh {
  PlanarPositions vertices;  ///< (n, 2) [m]
  Triangles triangles;       ///< (m, 3)

  int vertex_count() const { return static_cast<int>(vertices.rows()); }
  int triangle_count() const { return static_cast<int>(triangles.rows()); }
};

/// Twice the signed area of triangle t [m^2].
inline double doubled_area(const PlanarPositions& vertices, const Triangles& triangles, int t)
{
  const Eigen::RowVector2d a = vertices.row(triangles(t, 0));
  const Eigen::RowVector2d u = vertices.row(triangles(t, 1)) - a, v = vertices.row(triangles(t, 2)) - a;
  return u.x() * v.y() - u.y() * v.x();
}

}  // namespace softform
