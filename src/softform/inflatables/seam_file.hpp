#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "softform/core/types.hpp"

namespace softform {

/// Where a seam passes: a point close to the target, or a place on an earlier seam.
struct SeamPoint {
  Vec3 position = Vec3::Zero();    ///< of the point, or near the place on the earlier seam
  std::string on = {};             ///< name of the earlier seam, if any
  std::optional<double> fraction;  ///< of that seam's length, in place of a position
};

/// A curve on the target as drawn by its control points.
struct DrawnSeam {
  std::string name;
  double weight = 1;  ///< sigma of (6.18), not negative
  bool is_closed = false;
  std::vector<SeamPoint> points;  ///< at least 2, at least 3 of a closed seam
};

/// A panel inside the structure that is stretched out between two seams.
struct DrawnWall {
  std::string name;
  std::array<std::string, 2> between;
};

/// A name for the panel that holds a point of the target.
struct PanelName {
  std::string name;
  Vec3 inside = Vec3::Zero();
};

/// All that is drawn on a target; coordinates in the target's unit.
struct SeamPlan {
  std::string source;  ///< what the user knows it by: its file
  std::vector<DrawnSeam> seams;
  std::vector<DrawnWall> walls;
  std::vector<PanelName> panels;
};

/// Reads a seam file:
///   {"comment": "...",
///    "seams": [{"name": "neck", "closed": true, "weight": 1, "points": [[0, 1, 2], [1, 1, 2], [0, 1, 3]]},
///              {"name": "back", "points": [{"on": "neck", "at": 0.5}, [0, 0, 3], {"on": "neck", "near": [1, 1, 2]}]}],
///    "walls": [{"name": "brace", "between": ["neck", "back"]}],
///    "panels": [{"name": "head", "inside": [0, 2, 2]}]}
/// Only seams with names and points are required. Throws InputError naming the file, the seam and point, and the cure;
/// unknown keys are refused.
SeamPlan read_seam_file(const std::filesystem::path& file);

/// The plan for a target scaled about the origin.
[[nodiscard]] SeamPlan scaled(SeamPlan plan, double factor);

}  // namespace softform
