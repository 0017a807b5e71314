#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "softform/materials/material.hpp"

namespace softform {

/// Reads a material from JSON:
///     {"model": "hart_smith", "parameters": {"G": "0.16163 MPa", "k1": 0.0219, "k2": 0.2453}, "source": "..."}
/// Moduli are strings with a unit, dimensionless parameters are numbers, "source" says where the values come from.
/// Throws InputError naming the file, the key and the cure (and the line, for a file that is no JSON).
std::unique_ptr<Material> read_material(const std::filesystem::path& file);

/// Writes a material in that format, moduli in Pa to full precision. Throws InputError when the file cannot be
/// written.
void write_material(const std::filesystem::path& file, const Material& material, const std::string& source);

/// A material by file name or, where there is no such file, by its name NAME.json in the folder `materials` of
/// $SOFTFORM_DATA, of the checkout or of the installation. Throws InputError listing the known names.
std::unique_ptr<Material> load_material(const std::string& name_or_path);

}  // namespace softform
