#pragma once

#include <filesystem>
#include <string>

#include "softform/mesh/triangle_mesh.hpp"

namespace softform {

/// The format that a file's extension names: off, obj, ply or stl. Throws InputError for another one.
std::string mesh_format(const std::filesystem::path& path);

/// Reads a triangle surface from OFF, OBJ, PLY or STL (ASCII or binary); the extension decides. The numbers are taken
/// as they are: these formats carry no unit. Quadrangles are split along their shorter diagonal; the corners of STL
/// triangles are merged where their coordinates are equal.
/// Throws InputError for a file that is missing, empty or unreadable, a polygon of more than four corners, a
/// coordinate that is not finite and a corner index out of range. Whether the surface can be used is for check_mesh.
TriangleMesh read_mesh(const std::filesystem::path& path);

/// Writes OFF or OBJ (17 digits), PLY (binary, double) or STL (binary, single precision); the extension decides.
/// The file appears under its name only when complete. Throws InputError when it cannot be written.
void write_mesh(const std::filesystem::path& path, const TriangleMesh& mesh);

}  // namespace softform
