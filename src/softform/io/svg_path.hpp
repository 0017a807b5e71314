#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

namespace softform {

/// A subpath of an SVG path as a polyline, in the path's own unit.
struct SvgSubpath {
  std::vector<Eigen::Vector2d> points;
  bool is_closed = false;  ///< by Z, or because it ends where it began
};

/// The subpaths of a path's `d` (SVG 1.1, 8.3): lines, Bezier curves and elliptical arcs, flattened to within
/// `tolerance`. Throws InputError naming the place in the text.
std::vector<SvgSubpath> flatten_svg_path(const std::string& d, double tolerance);

}  // namespace softform
