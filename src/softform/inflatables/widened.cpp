#include <algorithm>

#include <fmt/format.h>

#include "softform/core/error.hpp"
#include "softform/inflatables/clipper_internal.hpp"
#include "softform/inflatables/pattern.hpp"

namespace softform {
namespace {

void require_simple(const clipper::Path& path)
{
  clipper::Paths parts;
  ClipperLib::SimplifyPolygon(path, parts, ClipperLib::pftNonZero);
  double area = 0;
  for (const clipper::Path& part : parts) area += ClipperLib::Area(part);
  // Where an outline crosses itself, what it encloses twice counts once here.
  if (parts.size() != 1 || std::abs(area - ClipperLib::Area(path)) > 1e-6 * std::abs(area))
    throw InputError("overlaps itself when flat: draw a seam through it");
}

}  // namespace

FlatPositions widened(const FlatPositions& polygon, double width)
{
  if (!(width > 0)) throw InputError("the seam allowance must be above 0: panels cannot be joined without any");
  const clipper::Path path = clipper::to_path(polygon);
  require_simple(path);
  constexpr double miter_limit = 2;
  ClipperLib::ClipperOffset offset(miter_limit);
  offset.AddPath(path, ClipperLib::jtMiter, ClipperLib::etClosedPolygon);
  clipper::Paths result;
  offset.Execute(result, width * clipper::units_per_metre);
  // Gaps that close may leave holes: only the outer outline is cut.
  return clipper::from_path(*std::max_element(result.begin(), result.end(), [](const auto& a, const auto& b) {
    return ClipperLib::Area(a) < ClipperLib::Area(b);
  }));
}

}  // namespace softform
