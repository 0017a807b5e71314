#include "softform/characters/strings.hpp"

#include <algorithm>
#include <cmath>

#include "softform/characters/sliding_places.hpp"
#include "softform/mesh/planar_mesh.hpp"

namespace softform {
namespace {

double cross(const Point<2>& a, const Point<2>& b) { return a.x() * b.y() - a.y() * b.x(); }

}  // namespace

Ring ring_around(const std::vector<Vec>& positions, double margin)
{
  Eigen::RowVector2d low = rows_of(positions.front()).row(0), high = low;
  for (const Vec& x : positions) {
    low = low.cwiseMin(rows_of(x).colwise().minCoeff());
    high = high.cwiseMax(rows_of(x).colwise().maxCoeff());
  }
  const Eigen::RowVector2d centre = (low + high) / 2;
  double radius = 0;
  for (const Vec& x : positions) radius = std::max(radius, (rows_of(x).rowwise() - centre).rowwise().norm().maxCoeff());
  return {centre.transpose(), margin * radius};
}

std::vector<String<2>> strings_of_pose(const BoundaryField& field, const StringLayout& layout, std::size_t pose)
{
  std::vector<String<2>> strings;
  for (std::size_t j = 0; j < layout.places.size(); ++j) {
    const std::vector<int> kernels = field.kernels(layout.places[j], layout.sides[j], field.radius());
    strings.push_back({spread_point(field.weights(layout.places[j], kernels)), layout.ring.at(layout.angles[j]),
                       layout.tensions[pose][static_cast<Eigen::Index>(j)]});
  }
  return strings;
}

StringPlan string_plan(const BoundaryField& field, const StringLayout& layout, const std::vector<Vec>& positions)
{
  StringPlan plan{layout.ring.centre, layout.ring.radius, {}};
  for (std::size_t j = 0; j < layout.places.size(); ++j) {
    StringPlan::Line& line = plan.strings.emplace_back();
    line.place = layout.places[j];
    line.ring_point = layout.ring.at(layout.angles[j]);
    const std::vector<BoundaryWeight> weights =
        field.weights(line.place, field.kernels(line.place, layout.sides[j], field.radius()));
    for (std::size_t i = 0; i < positions.size(); ++i) {
      line.tensions.push_back(layout.tensions[i][static_cast<Eigen::Index>(j)]);
      line.free_lengths.push_back((weighted_mean(weights, positions[i]) - line.ring_point).norm());
    }
  }
  return plan;
}

double length_inside(const Eigen::Matrix<int, Eigen::Dynamic, 2, Eigen::RowMajor>& edges, ConstVec x,
                     const Point<2>& from, const Point<2>& to)
{
  const Point<2> along = to - from;
  std::vector<double> crossings;  // as parts of the segment
  for (const auto& edge : edges.rowwise()) {
    const Point<2> a = x.segment<2>(2 * edge[0]), b = x.segment<2>(2 * edge[1]);
    const double side_a = cross(along, a - from), side_b = cross(along, b - from);
    if ((side_a < 0) == (side_b < 0)) continue;
    const Point<2> at = a + side_a / (side_a - side_b) * (b - a);
    const double t = along.dot(at - from) / along.squaredNorm();
    if (t > 0 && t < 1) crossings.push_back(t);
  }
  // Seen from outside, every second stretch is inside.
  std::sort(crossings.begin(), crossings.end(), std::greater<>());
  if (crossings.size() % 2 == 1) crossings.push_back(0);
  double inside = 0;
  for (std::size_t k = 0; k < crossings.size(); k += 2) inside += crossings[k] - crossings[k + 1];
  return inside * along.norm();
}

}  // namespace softform
