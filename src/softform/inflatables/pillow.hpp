#pragma once

#include <vector>

#include "softform/inflatables/panel_layout.hpp"
#include "softform/mesh/polygon.hpp"

namespace softform {

/// Two copies of a flat sheet sewn together along their boundary. `sheet` lies in the plane z = 0, faces +z and becomes
/// the front; the back is its mirror image. Nodes start with a slight bulge, on each side a tenth of their distance
/// from the boundary, for a flat pillow is singular.
/// Throws InputError unless the sheet is a disc.
PanelLayout pillow(const TriangleMesh& sheet);

/// Two sheets sewn together along their outlines, as they lie on each other: both polygons are seen from the front, run
/// counter-clockwise and are joined from their first corners on, at equal fractions of their lengths. Triangles have
/// edges of about `edge_length` [m]; corners of either outline become vertices of both. Throws InputError where an
/// outline crosses itself or the lengths differ by more than 2 %.
PanelLayout pillow(const Polygon& front, const Polygon& back, double edge_length);

/// A pillow whose front and back are joined inside by a wall along `line`: vertices of the sheet, one after the other
/// along its edges, from boundary to boundary. The wall is `height` [m] high and tapers to nothing at its two ends over
/// the length `taper` [m], where front and back meet. Front and back are cut there, into two panels each.
PanelLayout pillow_with_wall(const TriangleMesh& sheet, const std::vector<int>& line, double height, double taper);

/// Every triangle of a closed surface as a flat piece of its own, sewn to its neighbours: a structure of one panel
/// whose rest shape is the surface itself.
PanelLayout triangles_apart(const TriangleMesh& surface);

/// A flat disc in z = 0, facing +z, on a polar grid, so that edges run from the centre (vertex 0) to the rim, as radial
/// wrinkles do: spokes (2 rings - 1) triangles. Throws InputError unless radius > 0, spokes >= 3 and rings >= 1.
TriangleMesh spoked_disc(double radius, int spokes, int rings);

/// A flat rectangle in z = 0 about the origin, facing +z, of columns x rows cells halved by alternating diagonals;
/// vertex i + (columns + 1) j is in column i and row j. Throws InputError unless all arguments are positive.
TriangleMesh rectangle(double width, double height, int columns, int rows);

}  // namespace softform
