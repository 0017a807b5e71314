#include "pattern_results.hpp"

#include <algorithm>

#include "softform/inflatables/pattern_files.hpp"
#include "softform/io/text_file.hpp"

namespace softform::cli {

void write_pattern(const std::string& folder, const PanelLayout& layout, const std::vector<PatternPiece>& sheets)
{
  write_pattern_svg(folder + "/panels.svg", sheets);
  write_pattern_dxf(folder + "/panels.dxf", sheets);
  write_pattern_pdf(folder + "/panels.pdf", sheets);
  write_text(folder + "/seams.csv", seam_table(layout));
}

void write_flat_panels(const std::string& folder, const PanelLayout& layout)
{
  write_vtp(folder + "/flat.vtp", panels_side_by_side(layout), {{}, {panel_field(layout)}});
}

Field panel_field(const PanelLayout& layout) { return {"panel [1]", panel_numbers(layout)}; }

int wall_count(const PanelLayout& layout)
{
  return static_cast<int>(
      std::count_if(layout.panels.begin(), layout.panels.end(), [](const Panel& p) { return p.is_wall; }));
}

}  // namespace softform::cli
