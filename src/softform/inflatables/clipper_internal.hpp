#pragma once

#include <cmath>

#include <polyclipping/clipper.hpp>

#include "softform/inflatables/panel_layout.hpp"

/// Clipper's polygons of integers and the way to them and back.
namespace softform::clipper {

using ClipperLib::Path;
using ClipperLib::Paths;

/// A tenth of a micrometre: panels may measure a hundred metres before Clipper has to use wider integers.
constexpr double units_per_metre = 1e7;

inline ClipperLib::IntPoint to_point(double x, double y)
{
  return {std::llround(x * units_per_metre), std::llround(y * units_per_metre)};
}

inline Path to_path(const FlatPositions& polygon)
{
  Path path;
  for (Eigen::Index i = 0; i < polygon.rows(); ++i) path.push_back(to_point(polygon(i, 0), polygon(i, 1)));
  return path;
}

inline FlatPositions from_path(const Path& path)
{
  FlatPositions polygon(static_cast<Eigen::Index>(path.size()), 2);
  for (std::size_t i = 0; i < path.size(); ++i)
    polygon.row(static_cast<Eigen::Index>(i)) << static_cast<double>(path[i].X) / units_per_metre,
        static_cast<double>(path[i].Y) / units_per_metre;
  return polygon;
}

}  // namespace softform::clipper
