#pragma once

#include "softform/mesh/triangle_mesh.hpp"

namespace softform {

/// The corners of a closed polygon in the plane, (n, 2) [m]; the last one is joined to the first.
using Polygon = Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>;

/// Positive when the corners run counter-clockwise [m^2].
double signed_area(const Polygon& polygon);

/// Whether no side touches or crosses another one but at the corner that they share.
bool is_simple(const Polygon& polygon);

/// The length around [m].
double perimeter(const Polygon& polygon);

/// The inside of a polygon as a flat mesh in z = 0 that faces +z, of nearly equilateral triangles with edges of about
/// `edge_length` [m]. The corners are its first vertices, in order, and its whole boundary: no vertex is added between
/// them, so that sheets with equally many can be sewn together.
/// Throws InputError unless the polygon is simple and counter-clockwise.
TriangleMesh triangulated(const Polygon& polygon, double edge_length);

}  // namespace softform
