#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "softform/characters/islands.hpp"
#include "softform/mesh/region_surface.hpp"

namespace softform {

struct PrintOptions {
  double thickness = 0;          ///< that a planar body is extruded by [m]
  double printable_size = 1e-3;  ///< what is smaller cannot be made [m]
  ContactOptions contacts;
};

/// All that is made of one material: its surface, checked.
struct PrintedMaterial {
  CharacterMaterial material;
  RegionSurface surface;
  double volume = 0;                  ///< enclosed [m^3]
  std::vector<std::string> problems;  ///< why the surface cannot be printed as it is: empty, or a fault of ours
};

/// A layout of two materials as what is printed: one closed, oriented surface a material, in their places.
struct PrintedBody {
  std::vector<PrintedMaterial> materials;  ///< soft, then stiff; those that there are
  std::vector<Island> islands;
  double volume = 0;  ///< of the body at rest [m^3]
};

/// The body at rest with every element of the material that its density (m) is nearer to.
/// Throws InputError when a planar body has no thickness.
PrintedBody printed_body(const SimplexMesh<2>& rest, const Vec& densities, const PrintOptions& options);
PrintedBody printed_body(const SimplexMesh<3>& rest, const Vec& densities, const PrintOptions& options);

const char* to_string(CharacterMaterial material);

/// Writes <material>.stl for each (in mm), print.3mf with all of them in place, and islands.csv.
void write_printed_body(const std::filesystem::path& folder, const PrintedBody& body, bool is_planar,
                        const PrintOptions& options);

}  // namespace softform
