#pragma once

#include "softform/mesh/simplex_mesh.hpp"

namespace softform {

/// One row a vertex, (n, 2) [m]. Row-major, so that the flat view is x0 y0 x1 y1 ...
using PlanarPositions = Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>;

/// A triangulation of a part of the plane, counter-clockwise.
using PlanarMesh = SimplexMesh<2>;

/// The flat positions (2n) of a planar mesh as rows (n, 2). `x` must outlive the view.
inline Eigen::Map<const PlanarPositions> rows_of(const Vec& x) { return {x.data(), x.size() / 2, 2}; }

/// Twice the signed area of triangle t [m^2].
inline double doubled_area(const Vec& x, const Triangles& triangles, int t)
{
  const auto points = rows_of(x);
  const Eigen::RowVector2d a = points.row(triangles(t, 0));
  const Eigen::RowVector2d u = points.row(triangles(t, 1)) - a, v = points.row(triangles(t, 2)) - a;
  return u.x() * v.y() - u.y() * v.x();
}

}  // namespace softform
