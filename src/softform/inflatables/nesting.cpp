#include "softform/inflatables/nesting.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>

#include <fmt/format.h>

#include "softform/core/error.hpp"
#include "softform/inflatables/clipper_internal.hpp"

namespace softform {
namespace {

using clipper::Path;
using clipper::Paths;
using Vec2 = Eigen::Vector2d;

FlatPositions turned(const FlatPositions& polygon, double angle)
{
  Eigen::Matrix2d R;
  R << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
  return polygon * R.transpose();
}

/// Few vertices, but nothing of the polygon outside: what cleaning takes away was added before.
Path coarse_cover(const FlatPositions& polygon, double margin)
{
  constexpr double detail = 0.5e-3;
  ClipperLib::ClipperOffset offset;
  offset.AddPath(clipper::to_path(polygon), ClipperLib::jtMiter, ClipperLib::etClosedPolygon);
  Paths result;
  offset.Execute(result, (margin + detail) * clipper::units_per_metre);
  Path cover = result.front();
  ClipperLib::CleanPolygon(cover, detail * clipper::units_per_metre);
  return cover;
}

Path rectangle(double x0, double y0, double x1, double y1)
{
  return {clipper::to_point(x0, y0), clipper::to_point(x1, y0), clipper::to_point(x1, y1), clipper::to_point(x0, y1)};
}

/// Where the origin of `moving` must not be, or it would overlap `fixed`: the outline of fixed + (-moving).
Paths no_fit_polygon(const Path& fixed, Path moving)
{
  for (auto& p : moving) p.X = -p.X, p.Y = -p.Y;
  Paths sum, outlines;
  ClipperLib::MinkowskiSum(moving, fixed, sum, true);
  // Only outlines: that one piece would fit into a hole of another is given away.
  std::copy_if(sum.begin(), sum.end(), std::back_inserter(outlines), ClipperLib::Orientation);
  return outlines;
}

struct Placement {
  double angle;
  Vec2 offset;
  double right, top;  ///< ends of the piece there
};

struct Sheet {
  std::vector<Path> covers;  ///< of what lies on it
  PatternPiece drawing;
};

class Nest {
 public:
  explicit Nest(const NestingOptions& options) : options_(options)
  {
    const int steps = options.keeps_grain ? 2 : 12;
    for (int i = 0; i < steps; ++i) angles_.push_back(2 * std::numbers::pi * i / steps);
  }

  void add(const PatternPiece& piece)
  {
    for (Sheet& sheet : sheets_) {
      if (const auto placement = best_placement(piece, sheet)) return put(piece, *placement, sheet);
    }
    Sheet sheet = empty_sheet();
    const auto placement = best_placement(piece, sheet);
    if (!placement) refuse(piece);
    put(piece, *placement, sheet);
    sheets_.push_back(std::move(sheet));
  }

  std::vector<PatternPiece> drawings()
  {
    std::vector<PatternPiece> result;
    for (Sheet& sheet : sheets_) result.push_back(std::move(sheet.drawing));
    return result;
  }

 private:
  [[noreturn]] void refuse(const PatternPiece& piece) const
  {
    const Vec2 size = piece.cut().colwise().maxCoeff() - piece.cut().colwise().minCoeff();
    throw InputError(fmt::format(
        "panel '{}' measures {:.0f} x {:.0f} mm with its allowance and fits on no sheet of {:.0f} "
        "x {:.0f} mm: take a larger sheet, a smaller size, or draw a seam through the panel",
        piece.name, 1e3 * size.x(), 1e3 * size.y(), 1e3 * options_.sheet_width, 1e3 * options_.sheet_height));
  }

  Sheet empty_sheet() const
  {
    Sheet sheet;
    sheet.drawing.name = fmt::format("sheet {}", sheets_.size() + 1);
    sheet.drawing.lines.push_back(
        {PatternLayer::Sheet, clipper::from_path(rectangle(0, 0, options_.sheet_width, options_.sheet_height)), true});
    return sheet;
  }

  std::optional<Placement> best_placement(const PatternPiece& piece, const Sheet& sheet) const
  {
    std::optional<Placement> best;
    for (const double angle : angles_) {
      const auto placement = leftmost(turned(piece.cut(), angle), angle, sheet);
      if (placement && (!best || placement->right < best->right - 1e-6 ||
                        (placement->right < best->right + 1e-6 && placement->top < best->top)))
        best = placement;
    }
    return best;
  }

  /// Of all places on the sheet where the polygon overlaps nothing.
  std::optional<Placement> leftmost(const FlatPositions& polygon, double angle, const Sheet& sheet) const
  {
    const Vec2 low = polygon.colwise().minCoeff(), high = polygon.colwise().maxCoeff();
    const Vec2 first = Vec2::Constant(options_.gap) - low;
    const Vec2 last = Vec2(options_.sheet_width, options_.sheet_height) - Vec2::Constant(options_.gap) - high;
    if ((last - first).minCoeff() < 0) return std::nullopt;
    ClipperLib::Clipper difference;
    difference.AddPath(rectangle(first.x(), first.y(), last.x(), last.y()), ClipperLib::ptSubject, true);
    const Path cover = coarse_cover(polygon, 0.5 * options_.gap);
    for (const Path& other : sheet.covers) difference.AddPaths(no_fit_polygon(other, cover), ClipperLib::ptClip, true);
    Paths free;
    difference.Execute(ClipperLib::ctDifference, free, ClipperLib::pftNonZero, ClipperLib::pftNonZero);
    std::optional<Placement> best;
    for (const Path& path : free) {
      for (const auto& p : path) {
        const Vec2 offset = Vec2(static_cast<double>(p.X), static_cast<double>(p.Y)) / clipper::units_per_metre;
        if (!best || offset.x() < best->offset.x() || (offset.x() == best->offset.x() && offset.y() < best->offset.y()))
          best = Placement{angle, offset, offset.x() + high.x(), offset.y() + high.y()};
      }
    }
    return best;
  }

  void put(const PatternPiece& piece, const Placement& placement, Sheet& sheet) const
  {
    PatternPiece placed = moved(piece, placement.angle, placement.offset);
    sheet.covers.push_back(coarse_cover(placed.cut(), 0.5 * options_.gap));
    std::move(placed.lines.begin(), placed.lines.end(), std::back_inserter(sheet.drawing.lines));
    std::move(placed.texts.begin(), placed.texts.end(), std::back_inserter(sheet.drawing.texts));
  }

  const NestingOptions& options_;
  std::vector<double> angles_;
  std::vector<Sheet> sheets_;
};

double area(const PatternPiece& piece) { return std::abs(ClipperLib::Area(clipper::to_path(piece.cut()))); }

}  // namespace

std::vector<PatternPiece> nested(const std::vector<PatternPiece>& pieces, const NestingOptions& options)
{
  std::vector<std::size_t> order(pieces.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return area(pieces[a]) > area(pieces[b]); });
  Nest nest(options);
  for (const std::size_t i : order) nest.add(pieces[i]);
  return nest.drawings();
}

}  // namespace softform
