#pragma once

#include <cmath>
#include <vector>

#include "softform/characters/boundary_field.hpp"
#include "softform/equilibrium/loaded_solid.hpp"

namespace softform {

/// A planar body of given densities, its coordinates that are clamped, and the poses (2n) [m] that it is wanted in.
/// What is clamped stays where each target has it.
struct PosedBody {
  const PlanarSolid& body;
  Vec densities;
  FixedDofs held;
  std::vector<Vec> targets;

  std::size_t pose_count() const { return targets.size(); }
};

/// The circle around a planar body that carries the pulleys over which strings run (5.14).
struct Ring {
  Point<2> centre = Point<2>::Zero();  ///< [m]
  double radius = 0;                   ///< [m]

  /// The point at an angle [rad], counter-clockwise from the x axis.
  Point<2> at(double angle) const { return centre + radius * Point<2>(std::cos(angle), std::sin(angle)); }
};

/// The ring around all given positions (2n) of a body: centred in the box around them, its radius `margin` times the
/// largest distance of a vertex from there.
Ring ring_around(const std::vector<Vec>& positions, double margin = 1.2);

/// Strings: where each is tied to the boundary at rest, the side of the body that this is on, the angle on the ring at
/// which it leaves, and how hard it is drawn in each pose.
struct StringLayout {
  Ring ring;
  std::vector<Point<2>> places;  ///< (strings) [m]
  std::vector<Point<2>> sides;   ///< outward unit normals (strings)
  std::vector<double> angles;    ///< (strings) [rad]
  std::vector<Vec> tensions;     ///< by pose (strings) [N], not negative

  int count() const { return static_cast<int>(places.size()); }
};

/// The strings of a pose as what pulls at the body: each at its place, spread over the boundary's vertices (5.12).
std::vector<String<2>> strings_of_pose(const BoundaryField& field, const StringLayout& layout, std::size_t pose);

/// What is built and driven: where strings are tied and where they leave the ring, and for each pose how hard each is
/// drawn and how much of it is between body and ring. A slack string must be at least that long.
struct StringPlan {
  struct Line {
    Point<2> place, ring_point;        ///< on the body at rest, and on the ring [m]
    std::vector<double> tensions;      ///< by pose [N]
    std::vector<double> free_lengths;  ///< by pose [m]
  };

  Point<2> ring_centre = Point<2>::Zero();  ///< [m]
  double ring_radius = 0;                   ///< [m]
  std::vector<Line> strings;
};

/// positions: (2n) [m] of the body in each pose.
StringPlan string_plan(const BoundaryField& field, const StringLayout& layout, const std::vector<Vec>& positions);

/// How much of the segment between two points lies in the body [m]; `to` is outside. edges: the body's boundary (k, 2).
double length_inside(const Eigen::Matrix<int, Eigen::Dynamic, 2, Eigen::RowMajor>& edges, ConstVec x,
                     const Point<2>& from, const Point<2>& to);

}  // namespace softform
