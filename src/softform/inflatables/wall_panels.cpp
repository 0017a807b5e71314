#include "softform/inflatables/wall_panels.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "softform/core/error.hpp"
#include "softform/mesh/polygon_mesh.hpp"

namespace softform {
namespace {

using Vec2 = Eigen::Vector2d;

/// A corner of a wall's outline: in space, and in the strip laid flat.
struct StripVertex {
  Vec3 position;
  Vec2 flat = Vec2::Zero();
  int node = -1;  ///< of the layout; -1 where it has none yet
};

/// The strip between two rows of vertices, as triangles of their numbers: the first row's, then the second's.
class Strip {
 public:
  Strip(const PanelLayout& layout, const std::vector<int>& first, const std::vector<int>& second)
      : first_count_(first.size())
  {
    for (const auto* row : {&first, &second})
      for (const int node : *row) vertices_.push_back({layout.nodes.row(node), Vec2::Zero(), node});
    zip();
    unfold();
  }

  const StripVertex& first(std::size_t i) const { return vertices_[i]; }
  const StripVertex& second(std::size_t i) const { return vertices_[first_count_ + i]; }
  std::size_t first_count() const { return first_count_; }
  std::size_t second_count() const { return vertices_.size() - first_count_; }

  /// The point in space above a point of the flat strip.
  Vec3 lifted(const Vec2& p) const
  {
    double best = -1e300;
    Vec3 result = Vec3::Zero();
    for (const auto& t : triangles_) {
      Eigen::Matrix2d edges;
      edges << vertices_[t[1]].flat - vertices_[t[0]].flat, vertices_[t[2]].flat - vertices_[t[0]].flat;
      const Vec2 uv = edges.inverse() * (p - vertices_[t[0]].flat);
      const double inside = std::min({uv.x(), uv.y(), 1 - uv.sum()});
      if (inside <= best) continue;
      best = inside;
      result = (1 - uv.sum()) * vertices_[t[0]].position + uv.x() * vertices_[t[1]].position +
               uv.y() * vertices_[t[2]].position;
    }
    return result;
  }

 private:
  double distance(std::size_t a, std::size_t b) const { return (vertices_[a].position - vertices_[b].position).norm(); }

  /// From the rung (i, k), the shorter of the next two.
  void zip()
  {
    std::size_t i = 0, k = 0;
    const std::size_t n = first_count_;
    const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
      // A common end of the rows is in both: the triangle there has no area.
      if (vertices_[a].node != vertices_[b].node && vertices_[b].node != vertices_[c].node &&
          vertices_[c].node != vertices_[a].node)
        triangles_.push_back({a, b, c});
    };
    while (i + 1 < first_count() || k + 1 < second_count()) {
      const bool is_first =
          k + 1 == second_count() || (i + 1 < first_count() && distance(i + 1, n + k) < distance(i, n + k + 1));
      const std::size_t next = is_first ? ++i : n + ++k;
      add(is_first ? i - 1 : i, is_first ? n + k : n + k - 1, next);
    }
  }

  /// Lays one triangle after the other beside its predecessor.
  void unfold()
  {
    std::vector<bool> is_placed(vertices_.size(), false);
    const auto place = [&](std::size_t v, const Vec2& p) {
      for (std::size_t w = 0; w < vertices_.size(); ++w)
        if (vertices_[w].node == vertices_[v].node) vertices_[w].flat = p, is_placed[w] = true;
    };
    for (const auto& t : triangles_) {
      const auto [a, b, c] = t;
      if (!is_placed[a]) place(a, Vec2::Zero());
      if (!is_placed[b]) place(b, Vec2(0, distance(a, b)));
      if (is_placed[c]) continue;
      // c lies on the right of a -> b, where the strip goes on.
      const Vec2 along = (vertices_[b].flat - vertices_[a].flat).normalized(), aside(along.y(), -along.x());
      const Vec3 axis = (vertices_[b].position - vertices_[a].position).normalized();
      const Vec3 to_c = vertices_[c].position - vertices_[a].position;
      place(c, vertices_[a].flat + to_c.dot(axis) * along + to_c.cross(axis).norm() * aside);
    }
  }

  std::size_t first_count_;
  std::vector<StripVertex> vertices_;
  std::vector<std::array<std::size_t, 3>> triangles_;
};

class WallMaker {
 public:
  WallMaker(PanelLayout& layout, const SeamNetwork& network, const SeamPlan& plan, double edge_length)
      : layout_(layout), network_(network), plan_(plan), edge_length_(edge_length)
  {}

  void add(const DrawnWall& wall)
  {
    name_ = wall.name;
    std::vector<int> first = nodes_along(wall.between[0]), second = nodes_along(wall.between[1]);
    const auto gap = [&](int a, int b) { return (layout_.nodes.row(a) - layout_.nodes.row(b)).norm(); };
    if (gap(first.front(), second.front()) + gap(first.back(), second.back()) >
        gap(first.front(), second.back()) + gap(first.back(), second.front()))
      std::reverse(second.begin(), second.end());
    require_common_ends_only(first, second);
    const Strip strip(layout_, first, second);
    add_panel(wall, strip, outline(strip));
  }

 private:
  [[noreturn]] void refuse(const std::string& problem) const
  {
    throw InputError(fmt::format("{}: wall '{}': {}", plan_.source, name_, problem));
  }

  bool is_part_of(std::size_t segment, const std::string& seam) const
  {
    return plan_.seams[static_cast<std::size_t>(network_.segments[segment].seam)].name == seam;
  }

  std::vector<int> nodes_along(const std::string& seam) const
  {
    std::vector<int> nodes;
    for (std::size_t s = 0; s < network_.segments.size(); ++s) {
      if (!is_part_of(s, seam)) continue;
      if (!nodes.empty()) nodes.pop_back();
      for (const int v : layout_.seams[s].sides[0].vertices)
        nodes.push_back(layout_.node_of[static_cast<std::size_t>(v)]);
    }
    if (nodes.front() == nodes.back())
      refuse(fmt::format(
          "seam '{}' is closed, and the wall would be a ring: draw the seam in two halves, with a wall each", seam));
    return nodes;
  }

  void require_common_ends_only(const std::vector<int>& first, const std::vector<int>& second) const
  {
    for (std::size_t i = 0; i < first.size(); ++i)
      for (std::size_t k = 0; k < second.size(); ++k)
        if (first[i] == second[k] && !(i == 0 && k == 0) && !(i + 1 == first.size() && k + 1 == second.size()))
          refuse(fmt::format("its seams meet at {} before their ends: end them there",
                             place(layout_.nodes.row(first[i]))));
  }

  /// Around the strip: along the first row, over to the second, back along it, and over to the first. Free ends are
  /// divided into edges.
  std::vector<StripVertex> outline(const Strip& strip) const
  {
    std::vector<StripVertex> result;
    const auto cross = [&](const StripVertex& from, const StripVertex& to) {
      if (from.node == to.node) {
        result.pop_back();
        return;
      }
      const int parts = static_cast<int>(std::round((to.position - from.position).norm() / edge_length_));
      for (int i = 1; i < parts; ++i) {
        const double t = static_cast<double>(i) / parts;
        result.push_back({(1 - t) * from.position + t * to.position, (1 - t) * from.flat + t * to.flat});
      }
    };
    for (std::size_t i = 0; i < strip.first_count(); ++i) result.push_back(strip.first(i));
    cross(strip.first(strip.first_count() - 1), strip.second(strip.second_count() - 1));
    for (std::size_t i = strip.second_count(); i-- > 0;) result.push_back(strip.second(i));
    cross(strip.second(0), strip.first(0));
    return result;
  }

  void add_panel(const DrawnWall& wall, const Strip& strip, const std::vector<StripVertex>& outline)
  {
    FlatPositions polygon(static_cast<Eigen::Index>(outline.size()), 2);
    for (std::size_t i = 0; i < outline.size(); ++i) polygon.row(static_cast<Eigen::Index>(i)) = outline[i].flat;
    PlanarMesh mesh;
    try {
      mesh = triangulated_inside(polygon, edge_length_);
    } catch (const InputError&) {
      refuse("the strip between its seams overlaps itself when flat: divide the seams, with a wall for each part");
    }

    const int first_vertex = layout_.vertex_count(), first_triangle = layout_.triangle_count();
    const auto count = mesh.vertex_count();
    std::map<int, int> vertex_of;  // of the wall, by node
    for (int i = 0; i < count; ++i) {
      int node = i < static_cast<int>(outline.size()) ? outline[static_cast<std::size_t>(i)].node : -1;
      if (node < 0) {
        node = layout_.node_count();
        layout_.nodes.conservativeResize(node + 1, 3);
        layout_.nodes.row(node) = strip.lifted(mesh.vertices.row(i)).transpose();
      }
      layout_.node_of.push_back(node);
      vertex_of[node] = first_vertex + i;
    }
    layout_.flat.conservativeResize(first_vertex + count, 2);
    layout_.flat.bottomRows(count) = mesh.vertices;
    layout_.triangles.conservativeResize(first_triangle + mesh.triangles.rows(), 3);
    layout_.triangles.bottomRows(mesh.triangles.rows()) = mesh.triangles.array() + first_vertex;
    const auto panel = static_cast<int>(layout_.panels.size());
    layout_.panels.push_back(
        {wall.name, true, first_vertex, count, first_triangle, static_cast<int>(mesh.triangles.rows())});

    for (std::size_t s = 0; s < network_.segments.size(); ++s) {
      if (!is_part_of(s, wall.between[0]) && !is_part_of(s, wall.between[1])) continue;
      SeamSide side{panel, {}};
      for (const int v : layout_.seams[s].sides[0].vertices)
        side.vertices.push_back(vertex_of.at(layout_.node_of[static_cast<std::size_t>(v)]));
      layout_.seams[s].sides.push_back(std::move(side));
    }
  }

  PanelLayout& layout_;
  const SeamNetwork& network_;
  const SeamPlan& plan_;
  double edge_length_;
  std::string name_;
};

}  // namespace

void add_walls(PanelLayout& layout, const SeamNetwork& network, const SeamPlan& plan, double edge_length)
{
  WallMaker maker(layout, network, plan, edge_length);
  for (const DrawnWall& wall : plan.walls) maker.add(wall);
}

}  // namespace softform
