#include "softform/inflatables/panel_layout.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "softform/fem/membrane_element.hpp"

namespace softform {
namespace {

/// Sets that grow together.
class UnionFind {
 public:
  explicit UnionFind(int count) : parent_(static_cast<std::size_t>(count))
  {
    std::iota(parent_.begin(), parent_.end(), 0);
  }

  int find(int i)
  {
    while (parent(i) != i) i = parent(i) = parent(parent(i));
    return i;
  }
  void join(int i, int j) { parent(std::max(find(i), find(j))) = std::min(find(i), find(j)); }

 private:
  int& parent(int i) { return parent_[static_cast<std::size_t>(i)]; }
  std::vector<int> parent_;
};

using DirectedEdge = std::pair<int, int>;

/// A corner is 3 triangle + k. The one at the start of each directed edge; the next one is at its end.
std::map<DirectedEdge, int> corners_of(const Triangles& triangles)
{
  std::map<DirectedEdge, int> corners;
  for (int t = 0; t < triangles.rows(); ++t)
    for (int k = 0; k < 3; ++k) corners[{triangles(t, k), triangles(t, (k + 1) % 3)}] = 3 * t + k;
  return corners;
}

int next_corner(int corner) { return corner - corner % 3 + (corner + 1) % 3; }

/// Numbers sets by the order in which they are first asked for.
class Numbering {
 public:
  int operator()(int set) { return number_.try_emplace(set, static_cast<int>(number_.size())).first->second; }
  int size() const { return static_cast<int>(number_.size()); }

 private:
  std::map<int, int> number_;
};

/// What belongs together once a mesh is opened along its seams.
class Opening {
 public:
  Opening(const TriangleMesh& mesh, const std::vector<SeamChain>& chains)
      : corners_(corners_of(mesh.triangles)),
        same_panel_(mesh.triangle_count()),
        same_vertex_(3 * mesh.triangle_count())
  {
    std::map<DirectedEdge, bool> is_seam;
    for (const SeamChain& chain : chains)
      for (std::size_t i = 0; i + 1 < chain.vertices.size(); ++i)
        is_seam[std::minmax(chain.vertices[i], chain.vertices[i + 1])] = true;
    for (const auto& [edge, corner] : corners_) {
      const auto [start, end] = edge;
      if (start > end || is_seam.count(edge) > 0) continue;
      const int opposite = corners_.at({end, start});
      same_panel_.join(corner / 3, opposite / 3);
      same_vertex_.join(corner, next_corner(opposite));
      same_vertex_.join(next_corner(corner), opposite);
    }
  }

  int panel_set(int triangle) { return same_panel_.find(triangle); }
  int vertex_set(int corner) { return same_vertex_.find(corner); }

  /// The vertex sets left of a chain.
  std::vector<int> sets_along(const std::vector<int>& chain)
  {
    std::vector<int> sets;
    for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
      const int corner = corners_.at({chain[i], chain[i + 1]});
      if (i == 0) sets.push_back(vertex_set(corner));
      sets.push_back(vertex_set(next_corner(corner)));
    }
    return sets;
  }

  int triangle_left_of(int start, int end) const { return corners_.at({start, end}) / 3; }

 private:
  std::map<DirectedEdge, int> corners_;
  UnionFind same_panel_, same_vertex_;
};

double length_along(const FlatPositions& flat, const std::vector<int>& vertices)
{
  double length = 0;
  for (std::size_t i = 0; i + 1 < vertices.size(); ++i)
    length += (flat.row(vertices[i + 1]) - flat.row(vertices[i])).norm();
  return length;
}

}  // namespace

PanelLayout split_along(const TriangleMesh& mesh, const std::vector<SeamChain>& chains)
{
  Opening opening(mesh, chains);
  Numbering panel_number;
  std::vector<std::vector<int>> triangles_of;
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    const auto panel = static_cast<std::size_t>(panel_number(opening.panel_set(t)));
    triangles_of.resize(std::max(triangles_of.size(), panel + 1));
    triangles_of[panel].push_back(t);
  }

  PanelLayout layout;
  layout.nodes = mesh.vertices;
  layout.triangles.resize(mesh.triangle_count(), 3);
  Numbering vertex_number;
  int row = 0;
  for (const std::vector<int>& triangles : triangles_of) {
    Panel panel{fmt::format("{}", layout.panels.size() + 1), false, vertex_number.size(), 0, row, 0};
    for (const int t : triangles) {
      for (int k = 0; k < 3; ++k) {
        const int v = layout.triangles(row, k) = vertex_number(opening.vertex_set(3 * t + k));
        if (v == layout.vertex_count()) layout.node_of.push_back(mesh.triangles(t, k));
      }
      ++row;
    }
    panel.vertex_count = vertex_number.size() - panel.first_vertex;
    panel.triangle_count = row - panel.first_triangle;
    layout.panels.push_back(std::move(panel));
  }
  layout.flat = FlatPositions::Zero(layout.vertex_count(), 2);

  for (const SeamChain& chain : chains) {
    std::vector<int> reversed(chain.vertices.rbegin(), chain.vertices.rend());
    SeamSide left, right;
    for (const int set : opening.sets_along(chain.vertices)) left.vertices.push_back(vertex_number(set));
    for (const int set : opening.sets_along(reversed)) right.vertices.push_back(vertex_number(set));
    std::reverse(right.vertices.begin(), right.vertices.end());
    left.panel = panel_number(opening.panel_set(opening.triangle_left_of(chain.vertices[0], chain.vertices[1])));
    right.panel = panel_number(opening.panel_set(opening.triangle_left_of(chain.vertices[1], chain.vertices[0])));
    layout.seams.push_back({chain.name, chain.weight, {std::move(left), std::move(right)}});
  }
  return layout;
}

Triangles node_triangles(const PanelLayout& layout)
{
  return layout.triangles.unaryExpr([&](int v) { return layout.node_of[static_cast<std::size_t>(v)]; });
}

std::vector<int> panel_of_triangles(const PanelLayout& layout)
{
  std::vector<int> panels(static_cast<std::size_t>(layout.triangle_count()));
  for (std::size_t i = 0; i < layout.panels.size(); ++i)
    std::fill_n(panels.begin() + layout.panels[i].first_triangle, layout.panels[i].triangle_count, static_cast<int>(i));
  return panels;
}

std::vector<std::vector<int>> boundary_loops(const Triangles& triangles)
{
  const auto corners = corners_of(triangles);
  std::map<int, int> next;  // along the boundary
  for (const auto& [edge, corner] : corners)
    if (corners.count({edge.second, edge.first}) == 0) next[edge.first] = edge.second;

  std::vector<std::vector<int>> loops;
  while (!next.empty()) {
    std::vector<int>& loop = loops.emplace_back();
    for (auto it = next.begin(); it != next.end();) {
      loop.push_back(it->first);
      const int following = it->second;
      next.erase(it);
      it = next.find(following);
    }
  }
  return loops;
}

std::vector<std::vector<int>> boundary_loops(const PanelLayout& layout, int panel)
{
  const Panel& p = layout.panels[static_cast<std::size_t>(panel)];
  return boundary_loops(layout.triangles.middleRows(p.first_triangle, p.triangle_count));
}

TriangleMesh panel_mesh(const PanelLayout& layout, int panel)
{
  const Panel& p = layout.panels[static_cast<std::size_t>(panel)];
  TriangleMesh mesh;
  mesh.triangles = layout.triangles.middleRows(p.first_triangle, p.triangle_count).array() - p.first_vertex;
  mesh.vertices.resize(p.vertex_count, 3);
  for (int i = 0; i < p.vertex_count; ++i)
    mesh.vertices.row(i) = layout.nodes.row(layout.node_of[static_cast<std::size_t>(p.first_vertex + i)]);
  return mesh;
}

TriangleMesh skin_mesh(const PanelLayout& layout, ConstVec x)
{
  int skins = 0;  // they come first
  for (const Panel& panel : layout.panels) skins += panel.is_wall ? 0 : panel.triangle_count;
  return {unflatten(x), node_triangles(layout).topRows(skins)};
}

TriangleMesh panels_side_by_side(const PanelLayout& layout)
{
  TriangleMesh mesh{Positions::Zero(layout.vertex_count(), 3), layout.triangles};
  mesh.vertices.leftCols(2) = layout.flat;
  double x = 0;
  for (const Panel& panel : layout.panels) {
    auto rows = mesh.vertices.middleRows(panel.first_vertex, panel.vertex_count);
    rows.col(0).array() += x - rows.col(0).minCoeff();
    x = rows.col(0).maxCoeff() * 1.02;
  }
  return mesh;
}

Vec flat_quality(ConstVec flat, const Triangles& triangles)
{
  Vec quality(triangles.rows());
  for (int t = 0; t < triangles.rows(); ++t) {
    const FlatTriangleEdges e(flat, triangles(t, 0), triangles(t, 1), triangles(t, 2));
    const double squares = e.u.squaredNorm() + e.v.squaredNorm() + (e.u - e.v).squaredNorm();
    quality[t] = 2 * std::sqrt(3.0) * (e.u.x() * e.v.y() - e.u.y() * e.v.x()) / squares;
  }
  return quality;
}

Vec flat_quality(const PanelLayout& layout)
{
  return flat_quality(Eigen::Map<const Vec>(layout.flat.data(), layout.flat.size()), layout.triangles);
}

Vec panel_numbers(const PanelLayout& layout)
{
  const std::vector<int> panels = panel_of_triangles(layout);
  return Eigen::Map<const Eigen::VectorXi>(panels.data(), layout.triangle_count()).cast<double>();
}

std::vector<double> side_lengths(const PanelLayout& layout, const Seam& seam)
{
  std::vector<double> lengths;
  for (const SeamSide& side : seam.sides) lengths.push_back(length_along(layout.flat, side.vertices));
  return lengths;
}

std::vector<double> relative_mismatches(const PanelLayout& layout, const Seam& seam)
{
  const std::vector<double> lengths = side_lengths(layout, seam);
  std::vector<double> mismatches;
  for (std::size_t k = 1; k < lengths.size(); ++k)
    mismatches.push_back(2 * std::abs(lengths[k] - lengths[0]) / (lengths[k] + lengths[0]));
  return mismatches;
}

SeamMismatch seam_mismatch(const PanelLayout& layout)
{
  SeamMismatch result;
  int count = 0;
  for (const Seam& seam : layout.seams) {
    for (const double mismatch : relative_mismatches(layout, seam)) {
      result.max = std::max(mismatch, result.max);
      result.mean += mismatch;
      ++count;
    }
  }
  if (count > 0) result.mean /= count;
  return result;
}

}  // namespace softform
