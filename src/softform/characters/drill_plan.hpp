#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "softform/mesh/planar_mesh.hpp"

namespace softform {

struct DrillOptions {
  double hole_diameter = 2e-3;  ///< of the pins [m]
  double margin = 0.015;        ///< of the plate around everything that lies on it [m]
};

/// What a plate is drilled for: the holes of one pose.
struct DrillPose {
  std::string name;                    ///< letters, digits, '_' and '-'
  std::vector<Eigen::Vector2d> holes;  ///< of the pins, in their order, in the body's coordinates [m]
  Vec positions;                       ///< (2n) of the body in this pose [m]
};

/// A plate for every pose, all of the same size and with the same place of the body's coordinates: holes are measured
/// from the plate's lower left corner, the datum.
struct DrillPlan {
  std::vector<DrillPose> poses;
  Triangles triangles;  ///< of the body, to draw it
  DrillOptions options;
  Eigen::Vector2d datum;  ///< in the body's coordinates [m]
  Eigen::Vector2d size;   ///< of a plate [m]

  /// From the datum [m].
  Eigen::Vector2d hole(std::size_t pose, std::size_t pin) const { return poses[pose].holes[pin] - datum; }
};

/// A plan with a plate that has room for every pose. Coordinates of the datum are rounded down to whole millimetres.
/// Precondition: one pose at least, each with the same number of holes and vertices.
DrillPlan drill_plan(std::vector<DrillPose> poses, Triangles triangles, const DrillOptions& options = {});

/// Pairs of holes of a plate that leave less than half a diameter of material between them, in words: "wind: 2 and 3".
std::vector<std::string> crowded_holes(const DrillPlan& plan);

/// The plate of a pose at true scale in mm, as layers (groups): plate, body, holes with numbers and centre crosses,
/// dimensions from the datum (each hole's x below the plate, its y to the left) and, to the right, the table.
void write_drill_svg(const std::filesystem::path& path, const DrillPlan& plan, std::size_t pose);

/// All poses: pose, pin, x [mm], y [mm], diameter [mm], from the datum.
std::string drill_table(const DrillPlan& plan);

}  // namespace softform
