#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "softform/mesh/polygon.hpp"

namespace softform {

/// An outline drawn in an SVG file.
struct SvgOutline {
  std::string name;  ///< of the element: its id, or what and where it is
  Polygon points;    ///< counter-clockwise, y upwards [m]
};

/// The closed outlines of a drawing in the order of the file: paths, polygons, rectangles, circles and ellipses, with
/// the transforms of their groups. Curves become polygons that are off by `tolerance` [m] at most. The drawing's width
/// and viewBox give the unit; without a unit, 96 pixels are an inch.
/// Throws InputError naming file, element and cure where the file is no SVG, a path is open or unreadable, or there is
/// no outline.
std::vector<SvgOutline> read_svg_outlines(const std::filesystem::path& file, double tolerance = 1e-5);

}  // namespace softform
