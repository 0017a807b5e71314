#include "softform/characters/drill_plan.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "softform/io/text_file.hpp"

namespace softform {
namespace {

constexpr double mm = 1e3;
// Of the drawing around the plate [mm].
constexpr double room_for_dimensions = 34;
constexpr double room_above = 12;
constexpr double table_width = 62;
constexpr double font_size = 3;
constexpr double line_height = 4.2;
constexpr const char* text_color = "#203a60";

// Labels of a dimension row in the order of their places, moved apart where they would cover each other, as little as
// a single sweep can.
std::vector<double> spread(const std::vector<double>& places)
{
  std::vector<std::size_t> order(places.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](auto a, auto b) { return places[a] < places[b]; });
  std::vector<double> labels = places;
  for (std::size_t k = 1; k < order.size(); ++k)
    labels[order[k]] = std::max(labels[order[k]], labels[order[k - 1]] + line_height);
  // Half of what the last ones were pushed by is given back.
  double overhang = order.empty() ? 0 : labels[order.back()] - places[order.back()];
  for (std::size_t k = order.size(); overhang > 0 && k-- > 0;) {
    const double lowest = k > 0 ? labels[order[k - 1]] + line_height : -1e9;
    labels[order[k]] -= overhang / 2;
    if (labels[order[k]] >= lowest) break;
  }
  return labels;
}

// The drawing of one plate; x and y in mm, y downwards as SVG has it.
class Drawing {
 public:
  Drawing(const DrillPlan& plan, std::size_t pose)
      : plan_(plan), pose_(pose), width_(mm * plan.size.x()), height_(mm * plan.size.y())
  {}

  std::string text() const;

 private:
  double x(double from_datum) const { return room_for_dimensions + mm * from_datum; }
  double y(double from_datum) const { return room_above + height_ - mm * from_datum; }
  std::size_t pins() const { return plan_.poses[pose_].holes.size(); }
  std::string plate() const;
  std::string body() const;
  std::string holes() const;
  std::string dimensions() const;
  std::string table() const;

  const DrillPlan& plan_;
  std::size_t pose_;
  double width_, height_;
};

std::string label(double x, double y, const std::string& text, const char* anchor)
{
  return fmt::format("    <text x=\"{:.3f}\" y=\"{:.3f}\" text-anchor=\"{}\" fill=\"{}\" stroke=\"none\">{}</text>\n",
                     x, y, anchor, text_color, text);
}

std::string group(const char* id, const char* style, const std::string& content)
{
  return fmt::format("  <g id=\"{0}\" inkscape:groupmode=\"layer\" inkscape:label=\"{0}\" {1}>\n{2}  </g>\n", id, style,
                     content);
}

std::string Drawing::plate() const
{
  return fmt::format("    <rect x=\"{:.3f}\" y=\"{:.3f}\" width=\"{:.3f}\" height=\"{:.3f}\"/>\n", x(0),
                     y(plan_.size.y()), width_, height_);
}

std::string Drawing::body() const
{
  std::string d;
  const Vec& positions = plan_.poses[pose_].positions;
  const auto edges = boundary_faces<2>(plan_.triangles).faces;
  for (const auto& edge : edges.rowwise()) {
    const Eigen::Vector2d a = positions.segment<2>(2 * edge[0]) - plan_.datum;
    const Eigen::Vector2d b = positions.segment<2>(2 * edge[1]) - plan_.datum;
    d += fmt::format("M{:.3f},{:.3f} L{:.3f},{:.3f} ", x(a.x()), y(a.y()), x(b.x()), y(b.y()));
  }
  return fmt::format("    <path d=\"{}\"/>\n", d);
}

std::string Drawing::holes() const
{
  std::string text;
  const double radius = mm * plan_.options.hole_diameter / 2, arm = 1.8 * radius;
  for (std::size_t j = 0; j < pins(); ++j) {
    const Eigen::Vector2d at = plan_.hole(pose_, j);
    text += fmt::format("    <circle cx=\"{0:.3f}\" cy=\"{1:.3f}\" r=\"{2:.3f}\"/>\n", x(at.x()), y(at.y()), radius);
    text += fmt::format("    <path d=\"M{:.3f},{:.3f} h{:.3f} M{:.3f},{:.3f} v{:.3f}\" stroke-width=\"0.1\"/>\n",
                        x(at.x()) - arm, y(at.y()), 2 * arm, x(at.x()), y(at.y()) - arm, 2 * arm);
    text += fmt::format("    <text x=\"{:.3f}\" y=\"{:.3f}\" stroke=\"none\" fill=\"#c00000\">{}</text>\n",
                        x(at.x()) + 1.2 * arm, y(at.y()) - arm, j + 1);
  }
  return text;
}

// Ordinates from the datum: a line from each hole to the plate's edge, on to its label.
std::string Drawing::dimensions() const
{
  std::vector<double> columns, rows;
  for (std::size_t j = 0; j < pins(); ++j) {
    columns.push_back(x(plan_.hole(pose_, j).x()));
    rows.push_back(y(plan_.hole(pose_, j).y()));
  }
  const std::vector<double> column_labels = spread(columns), row_labels = spread(rows);
  const double bottom = y(0), left = x(0);
  std::string text = fmt::format("    <circle cx=\"{:.3f}\" cy=\"{:.3f}\" r=\"1.2\" fill=\"none\"/>\n", left, bottom) +
                     label(left - 2, bottom + 5, "0", "end");
  for (std::size_t j = 0; j < pins(); ++j) {
    const Eigen::Vector2d at = mm * plan_.hole(pose_, j);
    text += fmt::format("    <path d=\"M{:.3f},{:.3f} V{:.3f} L{:.3f},{:.3f} v2\"/>\n", columns[j], rows[j], bottom + 3,
                        column_labels[j], bottom + 8);
    text += fmt::format(
        "    <text transform=\"translate({:.3f} {:.3f}) rotate(-90)\" text-anchor=\"end\" fill=\"{}\" "
        "stroke=\"none\">{:.2f}</text>\n",
        column_labels[j] + font_size / 3, bottom + 11, text_color, at.x());
    text += fmt::format("    <path d=\"M{:.3f},{:.3f} H{:.3f} L{:.3f},{:.3f} h-2\"/>\n", columns[j], rows[j], left - 3,
                        left - 8, row_labels[j]);
    text += label(left - 11, row_labels[j] + font_size / 3, fmt::format("{:.2f}", at.y()), "end");
  }
  return text;
}

std::string Drawing::table() const
{
  const double left = room_for_dimensions + width_ + 8;
  double line = room_above + line_height;
  const auto row = [&](const std::string& pin, const std::string& x, const std::string& y) {
    std::string text =
        label(left + 8, line, pin, "end") + label(left + 28, line, x, "end") + label(left + 48, line, y, "end");
    line += line_height;
    return text;
  };
  std::string text =
      label(left, line, fmt::format("{}: holes of {:g} mm", plan_.poses[pose_].name, mm * plan_.options.hole_diameter),
            "start");
  line += line_height;
  text += label(left, line, "from the lower left corner, in mm", "start");
  line += 1.5 * line_height;
  text += row("pin", "x", "y");
  for (std::size_t j = 0; j < pins(); ++j) {
    const Eigen::Vector2d at = mm * plan_.hole(pose_, j);
    text += row(std::to_string(j + 1), fmt::format("{:.2f}", at.x()), fmt::format("{:.2f}", at.y()));
  }
  return text;
}

std::string Drawing::text() const
{
  const double table_height = (static_cast<double>(pins()) + 6) * line_height;
  const double width = room_for_dimensions + width_ + table_width;
  const double height = room_above + std::max(height_ + room_for_dimensions, table_height);
  std::string svg = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" "
      "xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\" width=\"{0:.3f}mm\" height=\"{1:.3f}mm\" "
      "viewBox=\"0 0 {0:.3f} {1:.3f}\" font-family=\"sans-serif\" font-size=\"{2}\">\n",
      width, height, font_size);
  svg += group("body", "fill=\"none\" stroke=\"#9a9a9a\" stroke-width=\"0.2\"", body());
  svg += group("plate", "fill=\"none\" stroke=\"#000000\" stroke-width=\"0.3\"", plate());
  svg += group("dimensions", "fill=\"none\" stroke=\"#3060b0\" stroke-width=\"0.1\"", dimensions());
  svg += group("holes", "fill=\"none\" stroke=\"#c00000\" stroke-width=\"0.2\"", holes());
  svg += group("table", "stroke=\"none\"", table());
  return svg + "</svg>\n";
}

}  // namespace

DrillPlan drill_plan(std::vector<DrillPose> poses, Triangles triangles, const DrillOptions& options)
{
  Eigen::RowVector2d lower = rows_of(poses.front().positions).row(0), upper = lower;
  for (const DrillPose& pose : poses) {
    const auto points = rows_of(pose.positions);
    lower = lower.cwiseMin(points.colwise().minCoeff());
    upper = upper.cwiseMax(points.colwise().maxCoeff());
    for (const Eigen::Vector2d& hole : pose.holes) {
      lower = lower.cwiseMin(hole.transpose());
      upper = upper.cwiseMax(hole.transpose());
    }
  }
  DrillPlan plan{std::move(poses), std::move(triangles), options, {}, {}};
  const auto whole = [](double metres) { return std::floor(metres * mm) / mm; };
  plan.datum = (lower.transpose().array() - options.margin).unaryExpr(whole);
  plan.size = -(-(upper.transpose() - plan.datum).array() - options.margin).unaryExpr(whole);
  return plan;
}

std::vector<std::string> crowded_holes(const DrillPlan& plan)
{
  std::vector<std::string> crowded;
  for (const DrillPose& pose : plan.poses)
    for (std::size_t j = 0; j < pose.holes.size(); ++j)
      for (std::size_t k = 0; k < j; ++k)
        if ((pose.holes[j] - pose.holes[k]).norm() < 1.5 * plan.options.hole_diameter)
          crowded.push_back(fmt::format("{}: {} and {}", pose.name, k + 1, j + 1));
  return crowded;
}

void write_drill_svg(const std::filesystem::path& path, const DrillPlan& plan, std::size_t pose)
{
  write_text(path, Drawing(plan, pose).text());
}

std::string drill_table(const DrillPlan& plan)
{
  std::string text = "pose,pin,x [mm],y [mm],diameter [mm]\n";
  for (std::size_t i = 0; i < plan.poses.size(); ++i)
    for (std::size_t j = 0; j < plan.poses[i].holes.size(); ++j)
      text += fmt::format("{},{},{:.3f},{:.3f},{:.3f}\n", plan.poses[i].name, j + 1, mm * plan.hole(i, j).x(),
                          mm * plan.hole(i, j).y(), mm * plan.options.hole_diameter);
  return text;
}

}  // namespace softform
