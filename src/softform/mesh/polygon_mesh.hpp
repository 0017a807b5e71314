#pragma once

#include "softform/mesh/triangle_mesh.hpp"

namespace softform {

/// Triangles inside a polygon in the plane z = 0.
struct PolygonMesh {
  Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor> vertices;  ///< (n, 2), the polygon's corners first
  Triangles triangles;                                                 ///< counter-clockwise
};

/// A constrained Delaunay mesh of a polygon (b, 2), counter-clockwise, whose corners become the only vertices on its
/// outline, so that neighbours can share them: inside, a triangular lattice of about `edge_length`, smoothed.
/// Throws InputError when the polygon has fewer than three corners, crosses itself or is clockwise.
PolygonMesh triangulated(const Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>& polygon, double edge_length);

}  // namespace softform
