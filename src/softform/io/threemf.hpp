#pragma once

#include <filesystem>

#include "softform/mesh/triangle_mesh.hpp"

namespace softform {

/// Writes a solid's surface as 3MF for a 3D printer: one object, in millimetres. `mesh` is in metres.
/// The file appears under its name only when complete. Throws InputError when it cannot be written.
void write_3mf(const std::filesystem::path& path, const TriangleMesh& mesh);

}  // namespace softform
