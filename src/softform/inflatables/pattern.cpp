#include "softform/inflatables/pattern.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "softform/core/error.hpp"

namespace softform {
namespace {

using Vec2 = Eigen::Vector2d;

FlatPositions points(std::initializer_list<Vec2> list)
{
  FlatPositions result(static_cast<Eigen::Index>(list.size()), 2);
  Eigen::Index i = 0;
  for (const Vec2& p : list) result.row(i++) = p.transpose();
  return result;
}

/// Width of a text by its height, for the sans-serif letters that we write.
double text_width(const std::string& text, double height) { return 0.75 * height * static_cast<double>(text.size()); }

double distance_to_outline(const Vec2& p, const FlatPositions& outline)
{
  double least = std::numeric_limits<double>::infinity();
  for (Eigen::Index i = 0; i < outline.rows(); ++i) {
    const Vec2 a = outline.row(i), ab = outline.row((i + 1) % outline.rows()).transpose() - a;
    const double t = std::clamp((p - a).dot(ab) / std::max(ab.squaredNorm(), 1e-300), 0.0, 1.0);
    least = std::min(least, (a + t * ab - p).norm());
  }
  return least;
}

/// A place on a side of a seam, and the unit normal out of the panel there.
struct SidePlace {
  Vec2 position, outward;
};

/// Draws one panel.
class PieceMaker {
 public:
  PieceMaker(const PanelLayout& layout, int panel, const PieceOptions& options)
      : layout_(layout), panel_(panel), options_(options)
  {
    const std::vector<int> loop = boundary_loops(layout, panel).front();
    outline_.resize(static_cast<Eigen::Index>(loop.size()), 2);
    for (std::size_t i = 0; i < loop.size(); ++i) {
      outline_.row(static_cast<Eigen::Index>(i)) = layout.flat.row(loop[i]);
      boundary_.insert({loop[i], loop[(i + 1) % loop.size()]});
    }
  }

  PatternPiece make()
  {
    const Panel& panel = layout_.panels[static_cast<std::size_t>(panel_)];
    piece_.name = panel.name;
    try {
      piece_.lines.push_back({PatternLayer::Cut, widened(outline_, options_.allowance), true});
    } catch (const InputError& error) {
      throw InputError(fmt::format("panel '{}': {}", panel.name, error.what()));
    }
    piece_.lines.push_back({PatternLayer::Seam, outline_, true});
    for (std::size_t s = 0; s < layout_.seams.size(); ++s)
      for (const SeamSide& side : layout_.seams[s].sides)
        if (side.panel == panel_) mark_side(s, side);
    label(panel);
    return std::move(piece_);
  }

 private:
  /// `along` counts edges from the seam's start, so that it is the same place of the seam on every side.
  SidePlace place_on(const SeamSide& side, double along) const
  {
    const auto last = static_cast<double>(side.vertices.size()) - 2;
    const auto i = static_cast<std::size_t>(std::clamp(std::floor(along), 0.0, last));
    const int from = side.vertices[i], to = side.vertices[i + 1];
    const Vec2 a = layout_.flat.row(from), b = layout_.flat.row(to);
    const Vec2 tangent = (b - a).normalized() * (boundary_.count({from, to}) > 0 ? 1 : -1);
    return {a + (along - static_cast<double>(i)) * (b - a), {tangent.y(), -tangent.x()}};
  }

  void mark_side(std::size_t seam, const SeamSide& side)
  {
    const auto edges = static_cast<double>(side.vertices.size() - 1);
    const double length = side_lengths(layout_, layout_.seams[seam]).front();
    const double count = std::max(1.0, std::round(length / options_.notch_spacing));
    const double between = options_.allowance / 4 * edges / length;  // the two of the double notch, in edges
    for (double k = 0; k < count; ++k) {
      const double along = edges * (k + 0.5) / count;
      const Vec2 outward = place_on(side, along).outward;
      if (k > 0) {
        add_notch(place_on(side, along).position, outward);
      } else {
        for (const double sign : {-0.5, 0.5}) add_notch(place_on(side, along + sign * between).position, outward);
      }
    }
    const double height = std::min(0.7 * options_.text_height, length / 4);
    const SidePlace middle = place_on(side, 0.5 * edges);
    add_text(middle.position - 1.2 * height * middle.outward, std::atan2(middle.outward.x(), -middle.outward.y()),
             height, fmt::format("{}", seam + 1));
  }

  void add_notch(const Vec2& position, const Vec2& outward)
  {
    piece_.lines.push_back(
        {PatternLayer::Notches, points({position, position + 0.8 * options_.allowance * outward}), false});
  }

  void add_text(const Vec2& center, double angle, double height, std::string text)
  {
    piece_.texts.push_back({PatternLayer::Labels, center, angle, height, std::move(text)});
  }

  /// Number, name and grain, around the triangle that is farthest from the outline.
  void label(const Panel& panel)
  {
    Vec2 center = Vec2::Zero();
    double room = -1;
    for (int t = panel.first_triangle; t < panel.first_triangle + panel.triangle_count; ++t) {
      Vec2 p = Vec2::Zero();
      for (int k = 0; k < 3; ++k) p += layout_.flat.row(layout_.triangles(t, k)).transpose() / 3;
      if (const double distance = distance_to_outline(p, outline_); distance > room) room = distance, center = p;
    }
    const std::string text = panel.name == std::to_string(panel_ + 1) ? "panel " + panel.name
                                                                      : fmt::format("{}: {}", panel_ + 1, panel.name);
    const auto [left, right] = chord_through(center);
    const double space = 1.5 * std::min(center.x() - left, right - center.x());
    const double height = options_.text_height * std::min(1.0, space / text_width(text, options_.text_height));
    const Vec2 aside(0, std::min(0.8 * height, 0.5 * room));
    add_text(center + aside, 0, height, text);
    add_grain(center - aside);
  }

  /// The ends of the panel on the line along the first axis through a point of it.
  std::pair<double, double> chord_through(const Vec2& p) const
  {
    double left = -std::numeric_limits<double>::infinity(), right = -left;
    for (Eigen::Index i = 0; i < outline_.rows(); ++i) {
      const Vec2 a = outline_.row(i), b = outline_.row((i + 1) % outline_.rows());
      if ((a.y() > p.y()) == (b.y() > p.y())) continue;
      const double x = a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
      if (x < p.x()) left = std::max(left, x);
      if (x >= p.x()) right = std::min(right, x);
    }
    return {left, right};
  }

  /// A double arrow along the first axis through p, over most of the panel's width there.
  void add_grain(const Vec2& p)
  {
    const auto [left, right] = chord_through(p);
    const double half = 0.3 * (right - left), head = std::min(0.25 * half, 3e-3);
    const Vec2 middle(0.5 * (left + right), p.y()), along(half, 0);
    piece_.lines.push_back({PatternLayer::Grain, points({middle - along, middle + along}), false});
    for (const double sign : {-1.0, 1.0}) {
      const Vec2 tip = middle + sign * along, back = tip - Vec2(sign * head, 0), aside(0, head / 2);
      piece_.lines.push_back({PatternLayer::Grain, points({back + aside, tip, back - aside}), false});
    }
  }

  const PanelLayout& layout_;
  int panel_;
  const PieceOptions& options_;
  FlatPositions outline_;
  std::set<std::pair<int, int>> boundary_;  // directed edges, the panel on their left
  PatternPiece piece_;
};

}  // namespace

const std::vector<LayerStyle>& layer_styles()
{
  static const std::vector<LayerStyle> styles{
      {PatternLayer::Sheet, "sheet", "#9a9a9a", 8, 0.13e-3, 0},
      {PatternLayer::Cut, "cut", "#d00000", 1, 0.25e-3, 0},
      {PatternLayer::Seam, "seam", "#0040d0", 5, 0.18e-3, 2e-3},
      {PatternLayer::Notches, "notches", "#000000", 7, 0.25e-3, 0},
      {PatternLayer::Labels, "labels", "#000000", 7, 0.18e-3, 0},
      {PatternLayer::Grain, "grain", "#008040", 3, 0.18e-3, 0},
  };
  return styles;
}

const LayerStyle& style_of(PatternLayer layer) { return layer_styles()[static_cast<std::size_t>(layer)]; }

const FlatPositions& PatternPiece::cut() const
{
  return std::find_if(lines.begin(), lines.end(),
                      [](const PatternLine& line) { return line.layer == PatternLayer::Cut; })
      ->points;
}

PatternPiece moved(PatternPiece piece, double angle, const Vec2& offset)
{
  Eigen::Matrix2d R;
  R << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
  for (PatternLine& line : piece.lines)
    line.points = ((line.points * R.transpose()).rowwise() + offset.transpose()).eval();
  for (PatternText& text : piece.texts) {
    text.center = R * text.center + offset;
    text.angle += angle;
    if (std::cos(text.angle) < -1e-9) text.angle += std::numbers::pi;  // never upside down
  }
  return piece;
}

std::vector<PatternPiece> pattern_pieces(const PanelLayout& layout, const PieceOptions& options)
{
  std::vector<PatternPiece> pieces;
  for (std::size_t i = 0; i < layout.panels.size(); ++i)
    pieces.push_back(PieceMaker(layout, static_cast<int>(i), options).make());
  return pieces;
}

std::string seam_table(const PanelLayout& layout)
{
  const auto quoted = [](std::string text) {
    for (std::size_t i = 0; (i = text.find('"', i)) != std::string::npos; i += 2) text.insert(i, 1, '"');
    return '"' + text + '"';
  };
  const auto panel = [&](const SeamSide& side) {
    return quoted(layout.panels[static_cast<std::size_t>(side.panel)].name);
  };
  std::string table = "seam,name,left,right,left_length [mm],right_length [mm],mismatch [mm],relative_mismatch\n";
  for (std::size_t s = 0; s < layout.seams.size(); ++s) {
    const Seam& seam = layout.seams[s];
    const std::vector<double> lengths = side_lengths(layout, seam), mismatches = relative_mismatches(layout, seam);
    for (std::size_t k = 1; k < lengths.size(); ++k) {
      table += fmt::format("{},{},{},{},{:.3f},{:.3f},{:.3f},{:.6f}\n", s + 1, quoted(seam.name), panel(seam.sides[0]),
                           panel(seam.sides[k]), 1e3 * lengths[0], 1e3 * lengths[k],
                           1e3 * std::abs(lengths[0] - lengths[k]), mismatches[k - 1]);
    }
  }
  return table;
}

}  // namespace softform
