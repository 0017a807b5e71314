#include "softform/mesh/outline.hpp"

#include <algorithm>
#include <cmath>

namespace softform {
namespace {

using Vec2 = Eigen::Vector2d;

constexpr int dense_steps = 24;  // a segment's length is measured on so many chords

const OutlinePoint& at(const OutlineLoop& loop, int i)
{
  const int n = static_cast<int>(loop.size());
  return loop[static_cast<std::size_t>(((i % n) + n) % n)];
}

// The curve from point i to point i + 1 at t in [0, 1].
Vec2 hermite(const OutlineLoop& loop, int i, double t)
{
  const OutlinePoint &start = at(loop, i), &end = at(loop, i + 1);
  const Vec2 chord = end.position - start.position;
  const auto tangent = [&](int k) -> Vec2 {
    const OutlinePoint& point = at(loop, k);
    if (point.is_corner) return chord;
    const Vec2 before = point.position - at(loop, k - 1).position, after = at(loop, k + 1).position - point.position;
    // Scaled to this segment's length: points may be unequally far apart.
    return chord.norm() * (before + after) / (before.norm() + after.norm());
  };
  const double t2 = t * t, t3 = t2 * t;
  return (2 * t3 - 3 * t2 + 1) * start.position + (t3 - 2 * t2 + t) * tangent(i) + (3 * t2 - 2 * t3) * end.position +
         (t3 - t2) * tangent(i + 1);
}

// Dense points from point `first` to point `last` of the loop, both included.
std::vector<Vec2> dense_curve(const OutlineLoop& loop, int first, int last)
{
  std::vector<Vec2> points{at(loop, first).position};
  for (int i = first; i < last; ++i)
    for (int k = 1; k <= dense_steps; ++k) points.push_back(hermite(loop, i, static_cast<double>(k) / dense_steps));
  return points;
}

// Appends equally spaced points of the polyline, its last one left out.
void append_resampled(const std::vector<Vec2>& curve, double spacing, std::vector<Vec2>& result)
{
  std::vector<double> length{0};
  for (std::size_t i = 1; i < curve.size(); ++i) length.push_back(length.back() + (curve[i] - curve[i - 1]).norm());
  const int pieces = std::max(1, static_cast<int>(std::ceil(length.back() / spacing - 1e-9)));
  for (int k = 0; k < pieces; ++k) {
    const double s = length.back() * k / pieces;
    const auto upper = std::upper_bound(length.begin() + 1, length.end() - 1, s);
    const auto i = static_cast<std::size_t>(upper - length.begin());
    const double t = (s - length[i - 1]) / (length[i] - length[i - 1]);
    result.push_back((1 - t) * curve[i - 1] + t * curve[i]);
  }
}

}  // namespace

PlanarPositions sample(const OutlineLoop& loop, double spacing)
{
  const int n = static_cast<int>(loop.size());
  std::vector<int> stops;
  for (int i = 0; i < n; ++i)
    if (loop[static_cast<std::size_t>(i)].is_corner) stops.push_back(i);
  if (stops.empty()) stops.push_back(0);
  stops.push_back(stops.front() + n);

  std::vector<Vec2> points;
  for (std::size_t i = 0; i + 1 < stops.size(); ++i)
    append_resampled(dense_curve(loop, stops[i], stops[i + 1]), spacing, points);
  PlanarPositions result(static_cast<Eigen::Index>(points.size()), 2);
  for (std::size_t i = 0; i < points.size(); ++i) result.row(static_cast<Eigen::Index>(i)) = points[i].transpose();
  return result;
}

}  // namespace softform
