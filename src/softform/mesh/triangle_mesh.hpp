#pragma once

#include <array>
#include <vector>

#include "softform/core/types.hpp"

namespace softform {

/// A triangle surface in space.
struct TriangleMesh {
  Positions vertices;   ///< (n, 3) [m]
  Triangles triangles;  ///< (m, 3)

  int vertex_count() const { return static_cast<int>(vertices.rows()); }
  int triangle_count() const { return static_cast<int>(triangles.rows()); }
};

/// An edge (start, end) shared by two triangles: `left` is the third vertex of the triangle that runs start -> end,
/// `right` that of the one that runs end -> start. A boundary edge has right = -1.
struct Edge {
  int start, end, left, right;
};

/// Every edge once, ordered by its first appearance in the triangle list.
/// Throws InputError when more than two triangles, or two of the same orientation, share an edge.
std::vector<Edge> edges_of(const Triangles& triangles, int vertex_count);

/// Neighbours of every vertex, sorted.
std::vector<std::vector<int>> vertex_neighbours(const Triangles& triangles, int vertex_count);

/// Signed volume enclosed by a closed surface [m^3]; positive when the triangles face outwards.
double enclosed_volume(ConstVec x, const Triangles& triangles);
double enclosed_volume(const TriangleMesh& mesh);

/// Surface area [m^2].
double surface_area(ConstVec x, const Triangles& triangles);

/// A third of the area of the triangles around each vertex (n) [m^2].
Vec vertex_areas(ConstVec x, const Triangles& triangles);

/// Mean edge length [m].
double mean_edge_length(const TriangleMesh& mesh);

/// The largest distance between two vertices [m]: the thesis' size of a model.
double diameter(const Positions& vertices);

/// The mesh scaled about the origin so that its diameter() is `wanted` [m].
/// Precondition: two vertices differ.
[[nodiscard]] TriangleMesh scale_to_diameter(TriangleMesh mesh, double wanted);

/// Area-weighted unit normals of the vertices (n, 3).
Positions vertex_normals(ConstVec x, const Triangles& triangles);

}  // namespace softform
