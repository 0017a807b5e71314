#pragma once

#include <functional>

#include "softform/mesh/triangle_mesh.hpp"

namespace softform {

/// A closed, outward-oriented manifold of one component from a triangle soup: equal vertices merged, triangles
/// oriented, non-manifold vertices split, holes filled, the component of largest area kept.
/// Throws InputError when nothing closed comes of it.
TriangleMesh repaired(const TriangleMesh& mesh);

/// The surface of all that a ball of radius alpha cannot reach from outside, at a distance of `offset`: closes small
/// tunnels and drops what is inside (CGAL's Alpha_wrap_3). Lengths in the mesh's unit.
TriangleMesh shrink_wrapped(const TriangleMesh& mesh, double alpha, double offset);

struct RemeshOptions {
  /// Smallest angle [degrees] that a result may have: the membrane's element wants well-shaped triangles.
  double min_angle = 20;
  /// Edges with a sharper dihedral angle than this [degrees] stay as they are, so they should come with the length
  /// that the result's edges will have; 180 keeps none, for smooth shapes.
  double feature_angle = 180;
  /// Brings a point onto the exact surface; without it, to the closest point of the input.
  std::function<Vec3(const Vec3&)> projection = {};
};

/// Nearly equilateral triangles with exactly `vertex_count` vertices on the surface: isotropic remeshing to a few
/// per cent more, collapse of the shortest edges, then flips and tangential relaxation. The result is watertight, of
/// genus 0, free of self-intersections and within the angle wanted. Deterministic.
/// Precondition: the input is closed and oriented (see repaired()).
/// Throws InputError when the input has another genus or no attempt met all of that; the message says which one.
TriangleMesh remesh_to_vertex_count(const TriangleMesh& mesh, int vertex_count, const RemeshOptions& options = {});

/// The smallest angle of all triangles [degrees].
double smallest_angle(const TriangleMesh& mesh);

}  // namespace softform
