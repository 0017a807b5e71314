#include "softform/io/svg_outlines.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <numbers>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <pugixml.hpp>

#include "softform/core/error.hpp"
#include "softform/core/units.hpp"
#include "softform/io/svg_path.hpp"

namespace softform {
namespace {

constexpr double pixel = 0.0254 / 96;  // [m], CSS

class SvgReader {
 public:
  SvgReader(std::filesystem::path file, double tolerance) : file_(std::move(file)), tolerance_(tolerance) {}

  std::vector<SvgOutline> read()
  {
    pugi::xml_document document;
    const pugi::xml_parse_result result = document.load_file(file_.c_str());
    if (!result)
      throw InputError(fmt::format("{}: no SVG drawing ({}, character {}): export it again as plain SVG",
                                   file_.string(), result.description(), result.offset));
    const pugi::xml_node root = document.child("svg");
    if (!root) throw InputError(fmt::format("{}: it has no <svg> element: export it as plain SVG", file_.string()));
    unit_ = unit_of(root);
    visit(root, Eigen::Affine2d::Identity());
    if (outlines_.empty())
      throw InputError(fmt::format("{}: no closed outline in it: draw a closed path (text has to be turned into paths)",
                                   file_.string()));
    return std::move(outlines_);
  }

 private:
  // Metres of one unit of the drawing: the width over that of the viewBox.
  double unit_of(const pugi::xml_node& root) const
  {
    const std::string width = root.attribute("width").as_string();
    const std::vector<double> box = numbers(root.attribute("viewBox").as_string(), root);
    if (width.empty() || width.back() == '%') return pixel;
    if (box.empty()) return pixel;  // the drawing's numbers are pixels, whatever unit the page has
    const double metres = length(width);
    if (box.size() != 4 || !(box[2] > 0) || !(metres > 0)) refuse(root, "width and viewBox have to be positive");
    return metres / box[2];
  }

  static bool is_plain(const std::string& text)
  {
    return text.find_first_not_of("0123456789.eE+-") == std::string::npos;
  }

  double length(const std::string& text) const
  {
    if (is_plain(text)) return pixel * std::strtod(text.c_str(), nullptr);
    const std::string end = text.size() > 2 ? text.substr(text.size() - 2) : "";
    if (end == "px") return pixel * std::strtod(text.c_str(), nullptr);
    if (end == "pt") return 0.0254 / 72 * std::strtod(text.c_str(), nullptr);
    if (end == "pc") return 0.0254 / 6 * std::strtod(text.c_str(), nullptr);
    try {
      return parse_length(text);
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}: width: {}", file_.string(), error.what()));
    }
  }

  void visit(const pugi::xml_node& node, const Eigen::Affine2d& outer)
  {
    static const std::array<const char*, 8> hidden{"defs",   "clipPath", "mask",     "symbol",
                                                   "marker", "pattern",  "metadata", "style"};
    for (const pugi::xml_node& child : node.children()) {
      const char* kind = child.name();
      if (std::any_of(hidden.begin(), hidden.end(), [&](const char* name) { return std::strcmp(name, kind) == 0; }))
        continue;
      if (std::strcmp(kind, "use") == 0) refuse(child, "clones are not followed: unlink them in the drawing program");
      const Eigen::Affine2d transform = outer * transform_of(child);
      const std::string d = path_of(child);
      if (!d.empty()) add(child, d, transform);
      visit(child, transform);
    }
  }

  // Any shape as the path that SVG defines for it; empty for what is no shape.
  static std::string path_of(const pugi::xml_node& node)
  {
    const std::string kind = node.name();
    const auto value = [&](const char* name) { return node.attribute(name).as_double(); };
    if (kind == "path") return node.attribute("d").as_string();
    if (kind == "polygon") return fmt::format("M {} Z", node.attribute("points").as_string());
    if (kind == "rect")
      return fmt::format("M {} {} h {} v {} h {} Z", value("x"), value("y"), value("width"), value("height"),
                         -value("width"));
    if (kind != "circle" && kind != "ellipse") return "";
    const double rx = value(kind == "circle" ? "r" : "rx"), ry = value(kind == "circle" ? "r" : "ry");
    return fmt::format("M {0} {1} a {2} {3} 0 1 1 {4} 0 a {2} {3} 0 1 1 {5} 0 Z", value("cx") - rx, value("cy"), rx, ry,
                       2 * rx, -2 * rx);
  }

  void add(const pugi::xml_node& node, const std::string& d, const Eigen::Affine2d& transform)
  {
    const double scale = unit_ * std::sqrt(std::abs(transform.linear().determinant()));
    if (!(scale > 0)) refuse(node, "its transform has no area: remove it");
    std::vector<SvgSubpath> subpaths;
    try {
      subpaths = flatten_svg_path(d, tolerance_ / scale);
    } catch (const InputError& error) {
      refuse(node, error.what());
    }
    for (const SvgSubpath& path : subpaths) {
      if (path.points.size() < 2) continue;  // a move and nothing else
      if (!path.is_closed || path.points.size() < 3) refuse(node, "the path is open: close it, or delete it");
      SvgOutline outline{label(node), Polygon(Eigen::Index(path.points.size()), 2)};
      for (std::size_t i = 0; i < path.points.size(); ++i) {
        const Eigen::Vector2d point = unit_ * (transform * path.points[i]);
        outline.points.row(Eigen::Index(i)) << point.x(), -point.y();  // SVG's y points down
      }
      // Reversed from its second point on: the first one stays where it was drawn.
      if (signed_area(outline.points) < 0)
        outline.points.bottomRows(outline.points.rows() - 1) =
            outline.points.bottomRows(outline.points.rows() - 1).colwise().reverse().eval();
      outlines_.push_back(std::move(outline));
    }
  }

  // SVG 1.1, 7.6.
  Eigen::Affine2d transform_of(const pugi::xml_node& node) const
  {
    Eigen::Affine2d transform = Eigen::Affine2d::Identity();
    std::string text = node.attribute("transform").as_string();
    for (std::size_t open; (open = text.find('(')) != std::string::npos;) {
      const std::size_t close = text.find(')', open);
      if (close == std::string::npos) refuse(node, "its transform has no closing bracket");
      std::string name = text.substr(0, open);
      name.erase(0, name.find_first_not_of(" ,\t\n"));
      name.erase(name.find_last_not_of(" \t\n") + 1);
      transform = transform * single_transform(node, name, numbers(text.substr(open + 1, close - open - 1), node));
      text.erase(0, close + 1);
    }
    return transform;
  }

  Eigen::Affine2d single_transform(const pugi::xml_node& node, const std::string& name,
                                   const std::vector<double>& a) const
  {
    Eigen::Affine2d t = Eigen::Affine2d::Identity();
    if (name == "matrix" && a.size() == 6) {
      t.matrix().topRows<2>() << a[0], a[2], a[4], a[1], a[3], a[5];
    } else if (name == "translate" && (a.size() == 1 || a.size() == 2)) {
      t.translate(Eigen::Vector2d(a[0], a.size() == 2 ? a[1] : 0));
    } else if (name == "scale" && (a.size() == 1 || a.size() == 2)) {
      t.scale(Eigen::Vector2d(a[0], a.back()));
    } else if (name == "rotate" && (a.size() == 1 || a.size() == 3)) {
      const Eigen::Vector2d centre = a.size() == 3 ? Eigen::Vector2d(a[1], a[2]) : Eigen::Vector2d(0, 0);
      t.translate(centre).rotate(a[0] * std::numbers::pi / 180).translate(-centre);
    } else {
      refuse(node, fmt::format("the transform '{}' of {} numbers is not understood: apply it in the drawing program",
                               name, a.size()));
    }
    return t;
  }

  std::vector<double> numbers(const std::string& text, const pugi::xml_node& node) const
  {
    std::vector<double> values;
    const char* place = text.c_str();
    while (*(place += std::strspn(place, " ,\t\n\r")) != '\0') {
      char* end = nullptr;
      values.push_back(std::strtod(place, &end));
      if (end == place || !std::isfinite(values.back())) refuse(node, fmt::format("'{}' is no list of numbers", text));
      place = end;
    }
    return values;
  }

  std::string label(const pugi::xml_node& node) const
  {
    const char* id = node.attribute("id").as_string();
    return *id != '\0' ? fmt::format("<{}> '{}'", node.name(), id)
                       : fmt::format("<{}> at character {}", node.name(), node.offset_debug());
  }

  [[noreturn]] void refuse(const pugi::xml_node& node, const std::string& reason) const
  {
    throw InputError(fmt::format("{}: {}: {}", file_.string(), label(node), reason));
  }

  std::filesystem::path file_;
  double tolerance_;
  double unit_ = pixel;
  std::vector<SvgOutline> outlines_;
};

}  // namespace

std::vector<SvgOutline> read_svg_outlines(const std::filesystem::path& file, double tolerance)
{
  if (!std::filesystem::exists(file)) throw InputError(fmt::format("{}: no such file: check the path", file.string()));
  return SvgReader(file, tolerance).read();
}

}  // namespace softform
