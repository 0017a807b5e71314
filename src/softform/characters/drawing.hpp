#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "softform/characters/posed_mesh.hpp"
#include "softform/characters/skeleton.hpp"
#include "softform/equilibrium/potential.hpp"
#include "softform/mesh/outline.hpp"

namespace softform {

/// A planar character as it is drawn: its outline, the skeleton that its poses are made with, and the poses.
struct CharacterDrawing {
  struct Pose {
    std::string name;
    SkeletonPose bends;
  };

  /// A rectangle that holds what it contains, such as a foot in its stand.
  struct Hold {
    Eigen::Vector2d least, most;  ///< corners [m]
  };

  Outline outline;
  Skeleton skeleton;
  std::vector<Pose> poses;
  std::vector<Hold> holds;
};

/// Reads a drawing (datasets/characters/README.md describes the JSON; lengths in its `unit`, angles in degrees,
/// counter-clockwise). Throws InputError naming the file, the key and the cure.
CharacterDrawing read_drawing(const std::filesystem::path& file);

/// The drawing of that name in datasets/characters. Throws InputError as read_drawing() does.
CharacterDrawing load_drawing(const std::string& name);

/// A meshed character with its target poses; `held` is what the drawing holds, on its way all bones of a pose bend
/// together.
using PosedCharacter = PosedMesh<2>;

/// Meshes the outline with `triangle_count` triangles and poses it.
/// Throws InputError as triangulate_to_count() does, and when a pose turns a triangle over (it is named).
PosedCharacter make_character(const CharacterDrawing& drawing, int triangle_count);

}  // namespace softform
