#pragma once

#include "softform/mesh/triangle_mesh.hpp"

namespace softform {

/// Exact shapes with exactly the vertex count asked for: closed, outward-oriented, every vertex on the surface, nearly
/// equilateral triangles, the same on every call. Centred at the origin; lengths in the unit of the caller.
/// All throw InputError when the count is too small for the shape.

/// A sphere on the points of a golden-angle spiral: nearly equal areas. At least 12 vertices.
TriangleMesh sphere(double radius, int vertex_count);

/// A sphere whose triangulation has no symmetry, to see whether results depend on it. At least 100 vertices.
TriangleMesh irregular_sphere(double radius, int vertex_count);

/// A cube with its corners and edges in the mesh; inside its faces the triangulation is irregular.
/// At least 200 vertices.
TriangleMesh cube(double edge_length, int vertex_count);

/// The bumpsphere of thesis figure 4.6: a sphere with a round bump at each corner of an icosahedron. In direction u,
///     r(u) = radius (1 + h sum_i b(angle(u, c_i) / w)),   b(s) = (1 - s^2)^2 for s < 1, else 0,
/// with the corners' directions c_i, the height h = 0.15 and the half-angle w = 0.45 rad. At least 1000 vertices.
TriangleMesh bumpsphere(double radius, int vertex_count);

/// r(u) of the bumpsphere of radius 1. Precondition: |direction| > 0.
double bumpsphere_radius(const Vec3& direction);

}  // namespace softform
