#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/SparseCholesky>
#include <fmt/format.h>

#include "softform/core/error.hpp"
#include "softform/inflatables/pillow.hpp"

namespace softform {
namespace {

// Fractions of the length at the start of every side, and 1.
std::vector<double> fractions_of(const Polygon& polygon)
{
  std::vector<double> fractions{0};
  const Eigen::Index n = polygon.rows();
  for (Eigen::Index i = 0; i < n; ++i)
    fractions.push_back(fractions.back() + (polygon.row((i + 1) % n) - polygon.row(i)).norm());
  for (double& fraction : fractions) fraction /= fractions.back();
  fractions.back() = 1;
  return fractions;
}

// Where the outline turns by more than 20 degrees; the sides of a flattened curve turn less.
void add_corners(const Polygon& polygon, std::vector<double>& fractions)
{
  const std::vector<double> all = fractions_of(polygon);
  const Eigen::Index n = polygon.rows();
  for (Eigen::Index i = 1; i < n; ++i) {
    const Eigen::Vector2d a = polygon.row(i) - polygon.row(i - 1), b = polygon.row((i + 1) % n) - polygon.row(i);
    if (std::abs(std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b))) > 0.35) fractions.push_back(all[std::size_t(i)]);
  }
}

// Fractions in [0, 1) where both outlines get a vertex.
std::vector<double> common_fractions(const Polygon& front, const Polygon& back, double edge_length)
{
  const double step = edge_length / perimeter(front);
  std::vector<double> corners{0};
  add_corners(front, corners);
  add_corners(back, corners);
  std::sort(corners.begin(), corners.end());
  const auto is_close = [&](double a, double b) { return b - a < 0.25 * step; };
  corners.erase(std::unique(corners.begin(), corners.end(), is_close), corners.end());
  if (corners.size() > 1 && is_close(corners.back(), 1)) corners.pop_back();
  corners.push_back(1);
  std::vector<double> fractions;
  for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
    const double gap = corners[i + 1] - corners[i];
    const int count = std::max(1, int(std::lround(gap / step)));
    for (int k = 0; k < count; ++k) fractions.push_back(corners[i] + gap * k / count);
  }
  return fractions;
}

Polygon resampled(const Polygon& polygon, const std::vector<double>& fractions)
{
  const std::vector<double> all = fractions_of(polygon);
  Polygon result(Eigen::Index(fractions.size()), 2);
  for (std::size_t k = 0; k < fractions.size(); ++k) {
    const auto after = std::upper_bound(all.begin(), all.end() - 1, fractions[k]);
    const auto side = static_cast<std::size_t>(after - all.begin()) - 1;
    const double share = (fractions[k] - all[side]) / (all[side + 1] - all[side]);
    const Eigen::Index i = Eigen::Index(side), j = (i + 1) % polygon.rows();
    result.row(Eigen::Index(k)) = (1 - share) * polygon.row(i) + share * polygon.row(j);
  }
  return result;
}

// Positions of all vertices, those of the boundary (the first ones) given, the others at the mean of their neighbours.
Positions harmonic(const TriangleMesh& sheet, const Positions& boundary)
{
  const auto neighbours = vertex_neighbours(sheet.triangles, sheet.vertex_count());
  const int fixed = int(boundary.rows()), free = sheet.vertex_count() - fixed;
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::MatrixX3d right = Eigen::MatrixX3d::Zero(free, 3);
  for (int i = 0; i < free; ++i) {
    const std::vector<int>& around = neighbours[std::size_t(i + fixed)];
    entries.emplace_back(i, i, double(around.size()));
    for (const int j : around) {
      if (j >= fixed)
        entries.emplace_back(i, j - fixed, -1);
      else
        right.row(i) += boundary.row(j);
    }
  }
  SparseMatrix L(free, free);
  L.setFromTriplets(entries.begin(), entries.end());
  Positions positions(sheet.vertex_count(), 3);
  positions.topRows(fixed) = boundary;
  positions.bottomRows(free) = Eigen::SimplicialLDLT<SparseMatrix>(L).solve(right);
  return positions;
}

// Moves inner vertices to `side` by a tenth of their distance from the boundary (the first vertices).
void bulge(Positions& positions, Eigen::Index boundary, double side)
{
  for (Eigen::Index i = boundary; i < positions.rows(); ++i)
    positions(i, 2) +=
        0.1 * side * (positions.topRows(boundary).rowwise() - positions.row(i)).rowwise().norm().minCoeff();
}

}  // namespace

PanelLayout pillow(const Polygon& front, const Polygon& back, double edge_length)
{
  const double front_length = perimeter(front), back_length = perimeter(back);
  if (!(std::abs(front_length - back_length) <= 0.02 * front_length))
    throw InputError(
        fmt::format("the outlines are {:.4g} mm and {:.4g} mm long: to be sewn together their lengths may differ "
                    "by 2 % at most",
                    1e3 * front_length, 1e3 * back_length));
  const std::vector<double> fractions = common_fractions(front, back, edge_length);
  const TriangleMesh front_sheet = triangulated(resampled(front, fractions), edge_length);
  const TriangleMesh back_sheet = triangulated(resampled(back, fractions), edge_length);
  const auto boundary = Eigen::Index(fractions.size());
  const int inner_back = back_sheet.vertex_count() - int(boundary), front_count = front_sheet.vertex_count();

  // The closed surface; inner vertices of the back come after those of the front.
  TriangleMesh mesh;
  Positions front_nodes = front_sheet.vertices, back_nodes = harmonic(back_sheet, front_nodes.topRows(boundary));
  bulge(front_nodes, boundary, 1);
  bulge(back_nodes, boundary, -1);
  mesh.vertices.resize(front_count + inner_back, 3);
  mesh.vertices << front_nodes, back_nodes.bottomRows(inner_back);
  const auto node_of_back = [&](int i) { return i < boundary ? i : i - int(boundary) + front_count; };
  mesh.triangles.resize(front_sheet.triangle_count() + back_sheet.triangle_count(), 3);
  mesh.triangles.topRows(front_sheet.triangle_count()) = front_sheet.triangles;
  mesh.triangles.bottomRows(back_sheet.triangle_count()) =
      back_sheet.triangles.rowwise().reverse().unaryExpr(node_of_back);

  std::vector<int> rim;
  for (int i = 0; i <= boundary; ++i) rim.push_back(i % int(boundary));
  PanelLayout layout = split_along(mesh, {{"rim", 0, rim}});
  layout.panels.at(0).name = "front";
  layout.panels.at(1).name = "back";
  for (int v = 0; v < layout.vertex_count(); ++v) {
    const int node = layout.node_of[std::size_t(v)];
    const bool is_front = v < layout.panels[1].first_vertex;
    const int i = is_front || node < boundary ? node : node - front_count + int(boundary);
    const auto place = (is_front ? front_sheet : back_sheet).vertices.row(i);
    layout.flat.row(v) << (is_front ? 1 : -1) * place.x(), place.y();
  }
  return layout;
}

}  // namespace softform
