#include <algorithm>
#include <numbers>

#include <fmt/format.h>

#include "softform/inflatables/pattern_files.hpp"
#include "softform/io/text_file.hpp"

namespace softform {
namespace {

constexpr double mm = 1e3;
constexpr double gap_between_sheets = 20;  // [mm]

std::string escaped(const std::string& text)
{
  std::string result;
  for (const char c : text) {
    if (c == '&')
      result += "&amp;";
    else if (c == '<')
      result += "&lt;";
    else
      result += c;
  }
  return result;
}

/// SVG's second axis points down: `bottom` is where the sheet's zero lies [mm].
std::string line_element(const PatternLine& line, double bottom)
{
  std::string d;
  for (Eigen::Index i = 0; i < line.points.rows(); ++i)
    d += fmt::format("{}{:.3f},{:.3f}", i == 0 ? "M" : " L", mm * line.points(i, 0), bottom - mm * line.points(i, 1));
  return fmt::format("    <path d=\"{}{}\"/>\n", d, line.is_closed ? " Z" : "");
}

std::string text_element(const PatternText& text, double bottom)
{
  const double x = mm * text.center.x(), y = bottom - mm * text.center.y();
  // Capitals are some 0.72 of the font's size; the base line lies half of that below the centre.
  return fmt::format(
      "    <text x=\"{0:.3f}\" y=\"{1:.3f}\" dy=\"{2:.3f}\" font-size=\"{3:.3f}\" transform=\"rotate({4:.3f} {0:.3f} "
      "{1:.3f})\">{5}</text>\n",
      x, y, 0.5 * mm * text.height, mm * text.height / 0.72, -text.angle * 180 / std::numbers::pi, escaped(text.text));
}

std::string layer_group(const LayerStyle& style, const std::vector<PatternPiece>& sheets,
                        const std::vector<double>& bottoms)
{
  const bool is_text = style.layer == PatternLayer::Labels;
  std::string group = fmt::format(
      "  <g id=\"{0}\" inkscape:groupmode=\"layer\" inkscape:label=\"{0}\" fill=\"{1}\" stroke=\"{2}\" "
      "stroke-width=\"{3:.3f}\"{4} "
      "font-family=\"sans-serif\" text-anchor=\"middle\">\n",
      style.name, is_text ? style.color : "none", is_text ? "none" : style.color, mm * style.width,
      style.dash > 0 ? fmt::format(" stroke-dasharray=\"{:.3f}\"", mm * style.dash) : "");
  for (std::size_t i = 0; i < sheets.size(); ++i) {
    for (const PatternLine& line : sheets[i].lines)
      if (line.layer == style.layer) group += line_element(line, bottoms[i]);
    for (const PatternText& text : sheets[i].texts)
      if (text.layer == style.layer) group += text_element(text, bottoms[i]);
  }
  return group + "  </g>\n";
}

}  // namespace

void write_pattern_svg(const std::filesystem::path& path, const std::vector<PatternPiece>& sheets)
{
  double width = 0, height = 0;
  std::vector<double> bottoms;
  for (const PatternPiece& sheet : sheets) {
    const FlatPositions& frame = sheet.lines.front().points;
    width = std::max(width, mm * frame.col(0).maxCoeff());
    height += mm * frame.col(1).maxCoeff();
    bottoms.push_back(height);
    height += gap_between_sheets;
  }
  height -= gap_between_sheets;
  std::string svg = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" "
      "xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\" width=\"{0:.3f}mm\" height=\"{1:.3f}mm\" "
      "viewBox=\"0 0 {0:.3f} {1:.3f}\">\n",
      width, height);
  for (const LayerStyle& style : layer_styles()) svg += layer_group(style, sheets, bottoms);
  write_text(path, svg + "</svg>\n");
}

}  // namespace softform
