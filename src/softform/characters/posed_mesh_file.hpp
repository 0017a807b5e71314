#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "softform/characters/posed_mesh.hpp"

namespace softform {

struct PoseFile {
  std::string name;
  std::filesystem::path file;
};

/// Reads a body and its poses from meshes of the same connectivity: vertices and elements in the same order. In the
/// plane, triangles in z = 0 as .obj, .off, .ply or .vtu; in space, tetrahedra as .vtu, or closed surfaces as .obj,
/// .off or .ply, which TetGen fills with about `tetrahedra` tetrahedra (0: as few as it likes) and whose poses are
/// filled by filled_target(). `unit` [m] is that of the files' numbers. Throws InputError naming the file, and the
/// place and cure, for files that cannot be read, vertices that no element uses, bodies of several parts, poses of
/// another connectivity and elements that are turned over.
template <int dim>
PosedMesh<dim> read_posed_mesh(const std::filesystem::path& rest, const std::vector<PoseFile>& poses, double unit,
                               int tetrahedra = 0);

}  // namespace softform
