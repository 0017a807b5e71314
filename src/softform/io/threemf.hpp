#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "softform/mesh/triangle_mesh.hpp"

namespace softform {

/// A solid's surface under the name that the printer's program shows it by.
struct PrintedPart {
  std::string name;
  TriangleMesh mesh;  ///< in metres
};

/// Writes solids' surfaces as 3MF for a 3D printer: an object each, in their places, in millimetres.
/// The file appears under its name only when complete. Throws InputError when it cannot be written.
void write_3mf(const std::filesystem::path& path, const std::vector<PrintedPart>& parts);
/// The same for a single solid without a name.
void write_3mf(const std::filesystem::path& path, const TriangleMesh& mesh);

}  // namespace softform
