#pragma once

#include <vector>

#include "softform/mesh/outline.hpp"

namespace softform {

/// A conforming Delaunay triangulation of the region between the polygons (outer first, then holes), refined until no
/// angle is below 20.7 degrees and no edge above `edge_length` [m], then relaxed by Lloyd's iterations (CGAL's Mesh_2).
/// Deterministic. Throws InputError when a polygon has no area or two of them touch or cross.
PlanarMesh triangulate(const std::vector<PlanarPositions>& polygons, double edge_length);

/// The inside of one polygon for a mesh that is sewn to others: the corners are its first vertices, in order, and its
/// whole boundary, for constrained Delaunay refinement places new vertices inside only. Edges there are of about
/// `edge_length` [m]; Lloyd's iterations follow where they help the worst triangle.
/// Precondition: a simple, counter-clockwise polygon (see is_simple()).
PlanarMesh triangulate_inside(const PlanarPositions& polygon, double edge_length);

/// A triangulation of the outline with `triangle_count` triangles, or as near as the edge length can bring it: the
/// outline is sampled and refined at lengths that are varied until the count fits.
/// Throws InputError as above, and when the count is further than 2 % off.
PlanarMesh triangulate_to_count(const Outline& outline, int triangle_count);

}  // namespace softform
