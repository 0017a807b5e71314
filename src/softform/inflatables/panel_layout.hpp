#pragma once

#include <string>
#include <vector>

#include "softform/mesh/planar_mesh.hpp"
#include "softform/mesh/triangle_mesh.hpp"

namespace softform {

/// Positions in flat panels, (n, 2) [m].
using FlatPositions = PlanarPositions;

/// A flat piece of material. Its vertices and triangles are consecutive in the layout.
struct Panel {
  std::string name;
  bool is_wall = false;  ///< inside the structure: elastic, but without pressure
  int first_vertex = 0, vertex_count = 0;
  int first_triangle = 0, triangle_count = 0;
};

/// The part of a panel's boundary that is sewn into a seam.
struct SeamSide {
  int panel = 0;
  std::vector<int> vertices;  ///< panel vertices along the seam
};

/// Where panels are joined: at least two sides, all with equally many vertices in the seam's direction, vertex k of
/// each on the same node. Sides 0 and 1 are the skins left and right of it, seen from outside (one panel may be both);
/// further sides are walls. A seam meets others at its ends only; in a closed one the last vertex is the first.
struct Seam {
  std::string name;
  double weight = 0;  ///< sigma of (6.18): how much the seam has to stay where it was drawn
  std::vector<SeamSide> sides;
};

/// Flat panels and how they are joined. A panel vertex is a place in a flat panel; the panel vertices that are sewn
/// together share a node of the structure in space.
struct PanelLayout {
  Positions nodes;            ///< (n, 3) on the target [m]
  Triangles triangles;        ///< (m, 3) panel vertices, panel by panel; skins face outwards
  FlatPositions flat;         ///< (v, 2) [m]; triangles are counter-clockwise in it
  std::vector<int> node_of;   ///< (v) the node of every panel vertex
  std::vector<Panel> panels;  ///< skins first, then walls
  std::vector<Seam> seams;

  int node_count() const { return static_cast<int>(nodes.rows()); }
  int vertex_count() const { return static_cast<int>(node_of.size()); }
  int triangle_count() const { return static_cast<int>(triangles.rows()); }
};

/// Consecutive edges of a mesh that become a seam; closed when it ends where it begins.
struct SeamChain {
  std::string name;
  double weight = 0;
  std::vector<int> vertices;  ///< of the mesh, in the seam's direction
};

/// A closed mesh opened along chains of its edges; `nodes` are its vertices, `flat` is zero. Panels are named by
/// number, in the order of their first triangles. Precondition: chains meet at their ends only; no edge in two chains.
PanelLayout split_along(const TriangleMesh& mesh, const std::vector<SeamChain>& chains);

/// The triangles of the layout between nodes (m, 3).
Triangles node_triangles(const PanelLayout& layout);

/// The panel of every triangle (m).
std::vector<int> panel_of_triangles(const PanelLayout& layout);

/// The boundary of a surface as loops of vertices, with the triangles on their left; each vertex is in one at most.
std::vector<std::vector<int>> boundary_loops(const Triangles& triangles);

/// The panel's boundary as loops of panel vertices, counter-clockwise around the panel (holes are clockwise).
std::vector<std::vector<int>> boundary_loops(const PanelLayout& layout, int panel);

/// A panel alone as it lies on the target; its vertex i is first_vertex + i of the layout.
TriangleMesh panel_mesh(const PanelLayout& layout, int panel);

/// The skins in space, without walls: nodes (n) at x (3n) and the triangles between them.
TriangleMesh skin_mesh(const PanelLayout& layout, ConstVec x);

/// The flat panels in the plane z = 0, side by side along x with a gap of a fiftieth of what is there already.
TriangleMesh panels_side_by_side(const PanelLayout& layout);

/// The shape quality of every triangle (m) in flat positions (2v): 4 sqrt(3) signed area / sum of squared edge lengths,
/// 1 for an equilateral one, negative for one that is turned over.
Vec flat_quality(ConstVec flat, const Triangles& triangles);
Vec flat_quality(const PanelLayout& layout);

/// The number of the panel of every triangle (m), as a field to be drawn.
Vec panel_numbers(const PanelLayout& layout);

/// Lengths of a seam's sides in the flat panels [m].
std::vector<double> side_lengths(const PanelLayout& layout, const Seam& seam);

/// How much longer or shorter than side 0 each further side is, relative to the mean of both.
std::vector<double> relative_mismatches(const PanelLayout& layout, const Seam& seam);

/// The same over all seams.
struct SeamMismatch {
  double mean = 0, max = 0;
};
SeamMismatch seam_mismatch(const PanelLayout& layout);

/// A sphere in three equal lunes, 6 rows^2 triangles, its seams the meridians at 0, 120 and 240 degrees; flat panels by
/// the sinusoidal development, which keeps areas, parallels and the lengths along the middle. At least 2 rows.
PanelLayout three_lune_sphere(double radius, int rows);

}  // namespace softform
