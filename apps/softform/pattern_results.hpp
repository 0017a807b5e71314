#pragma once

#include <string>
#include <vector>

#include "softform/inflatables/pattern.hpp"
#include "softform/io/vtk_io.hpp"

namespace softform::cli {

/// panels.svg, .dxf and .pdf of the sheets, and seams.csv.
void write_pattern(const std::string& folder, const PanelLayout& layout, const std::vector<PatternPiece>& sheets);

/// flat.vtp, the flat panels side by side, with their numbers.
void write_flat_panels(const std::string& folder, const PanelLayout& layout);

/// The number of every triangle's panel.
Field panel_field(const PanelLayout& layout);

/// How many panels are walls.
int wall_count(const PanelLayout& layout);

}  // namespace softform::cli
