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
  Positions flat = Positions::Zero(layout.vertex_count(), 3);
  flat.leftCols(2) = layout.flat;
  double x = 0;
  for (const Panel& panel : layout.panels) {
    auto rows = flat.middleRows(panel.first_vertex, panel.vertex_count);
    rows.col(0).array() += x - rows.col(0).minCoeff();
    x = rows.col(0).maxCoeff() * 1.02;
  }
  write_vtp(folder + "/flat.vtp", {flat, layout.triangles}, {{}, {panel_field(layout)}});
}

Field panel_field(const PanelLayout& layout)
{
  const std::vector<int> panels = panel_of_triangles(layout);
  return {"panel [1]", Eigen::Map<const Eigen::VectorXi>(panels.data(), layout.triangle_count()).cast<double>()};
}

int wall_count(const PanelLayout& layout)
{
  return static_cast<int>(
      std::count_if(layout.panels.begin(), layout.panels.end(), [](const Panel& p) { return p.is_wall; }));
}

}  // namespace softform::cli
