#pragma once

#include <filesystem>
#include <vector>

#include "softform/inflatables/pattern.hpp"

namespace softform {

/// The sheets one above the other, in millimetres, one layer (group, as Inkscape understands it) for each kind of line.
void write_pattern_svg(const std::filesystem::path& path, const std::vector<PatternPiece>& sheets);

/// The sheets one above the other, in millimetres, DXF of AutoCAD 2000 with a layer for each kind of line.
void write_pattern_dxf(const std::filesystem::path& path, const std::vector<PatternPiece>& sheets);

/// The sheets at true scale on tiles of A4 paper that join edge to edge, with crosses at their corners and, on every
/// page, a rule of 100 mm to check the printer with. Tiles without lines are left out.
void write_pattern_pdf(const std::filesystem::path& path, const std::vector<PatternPiece>& sheets);

/// All throw InputError naming the file when it cannot be written. Precondition: each sheet has its frame.

}  // namespace softform
