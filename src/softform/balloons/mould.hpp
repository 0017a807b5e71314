#pragma once

#include <optional>
#include <vector>

#include "softform/balloons/nozzle.hpp"
#include "softform/mesh/triangle_mesh.hpp"

namespace softform {

/// A positive mould for dipping or brushing (thesis 4.5.1): the rest shape on a tube on a plate. Lengths in metres.
struct MouldOptions {
  double tube_length = 20e-3;                 ///< from the nozzle's centre to the plate
  std::optional<double> wall = std::nullopt;  ///< hollow, open through the tube; solid without it
  Vec3 plate{40e-3, 40e-3, 4e-3};
  double screw_diameter = 4.5e-3;  ///< of the holes near the plate's corners: M4 with clearance
  int screws = 4;                  ///< 0 or 4
};

struct Mould {
  TriangleMesh surface;
  int genus = 0;          ///< one for every screw hole; a hollow with one mouth adds none
  double closed_off = 0;  ///< volume of cavities that the bore does not reach, left solid [m^3]
};

/// The mould of a rest shape whose nozzle is given: rest shape, tube and plate united, hollowed when a wall is asked
/// for. The surface is closed, does not cut itself and faces outwards; all of that is checked, in the single precision
/// of STL. Throws InputError when an option is out of its range or the parts do not fit each other.
Mould make_mould(const TriangleMesh& rest, const Nozzle& nozzle, const MouldOptions& options = {});

/// Ways to take rubber off: away from the plate, and sideways four ways.
std::vector<Vec3> pull_directions(const Nozzle& nozzle);

/// What a maker wants to know of a mould before it is printed. One value a triangle.
struct MouldInspection {
  Vec thickness;              ///< of the material behind each triangle, along its normal [m]
  Vec gap;                    ///< of the air before each triangle, along its normal, at most the mould's size [m]
  std::vector<char> trapped;  ///< 1 where the mould is in the way of every pull direction
  double smallest_thickness = 0, smallest_gap = 0;  ///< all but 0.01 % of the area exceed them [m]
  Vec3 thinnest = Vec3::Zero();                     ///< where the material is thinnest [m]
  double thin_fraction = 0;                         ///< of the area, thinner than the printer's smallest feature
  double trapped_fraction = 0;                      ///< of the area of the rubber's part
};

/// Measures a mould of a rest shape. A triangle is trapped when, along every one of the pull directions in which its
/// rubber could be taken off, either it faces away or the mould is in the way: rubber has to stretch over what is
/// before it. Only triangles on the rest shape bear rubber; the others count as free. Throws InputError where there is
/// no direction, or one without a length, or the feature is not positive.
MouldInspection inspect_mould(const TriangleMesh& mould, const TriangleMesh& rest, const std::vector<Vec3>& pulls,
                              double smallest_feature);

}  // namespace softform
