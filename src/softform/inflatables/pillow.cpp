#include "softform/inflatables/pillow.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include <fmt/format.h>

#include "softform/core/error.hpp"

namespace softform {
namespace {

// The sheet's boundary in its direction, starting at the smallest vertex.
std::vector<int> boundary_of(const TriangleMesh& sheet)
{
  std::map<int, int> next;
  int edge_count = 0;
  for (const Edge& edge : edges_of(sheet.triangles, sheet.vertex_count())) {
    if (edge.right < 0) next[edge.start] = edge.end;
    ++edge_count;
  }
  if (next.empty()) throw InputError("a sheet without boundary: a pillow is sewn from flat sheets");
  std::vector<int> loop{next.begin()->first};
  while (next.at(loop.back()) != loop.front() && loop.size() <= next.size()) loop.push_back(next.at(loop.back()));
  if (loop.size() != next.size() || sheet.vertex_count() - edge_count + sheet.triangle_count() != 1)
    throw InputError("a sheet with holes or of several pieces: a pillow is sewn from sheets with one boundary");
  return loop;
}

// The closed surface of front and back, with the start bulge; the sheet's vertex i is back_of[i] on the back.
struct Sewn {
  TriangleMesh mesh;
  std::vector<int> boundary, back_of;
};

double distance_to(const Positions& points, const std::vector<int>& among, const Vec3& point)
{
  double smallest = std::numeric_limits<double>::infinity();
  for (const int i : among) smallest = std::min(smallest, (points.row(i).transpose() - point).norm());
  return smallest;
}

Sewn sew(const TriangleMesh& sheet)
{
  constexpr double bulge = 0.1;
  Sewn sewn;
  sewn.boundary = boundary_of(sheet);
  const int n = sheet.vertex_count(), m = sheet.triangle_count();
  sewn.back_of.assign(std::size_t(n), -1);
  for (const int i : sewn.boundary) sewn.back_of[std::size_t(i)] = i;
  int count = n;
  for (int& back : sewn.back_of)
    if (back < 0) back = count++;
  sewn.mesh.vertices.resize(count, 3);
  for (int i = 0; i < n; ++i) {
    const Vec3 point = sheet.vertices.row(i);
    const double z = bulge * distance_to(sheet.vertices, sewn.boundary, point);
    sewn.mesh.vertices.row(sewn.back_of[std::size_t(i)]) = point - z * Vec3::UnitZ();
    sewn.mesh.vertices.row(i) = point + z * Vec3::UnitZ();
  }
  sewn.mesh.triangles.resize(2 * m, 3);
  sewn.mesh.triangles.topRows(m) = sheet.triangles;
  for (int t = 0; t < m; ++t)
    for (int k = 0; k < 3; ++k) sewn.mesh.triangles(m + t, k) = sewn.back_of[std::size_t(sheet.triangles(t, 2 - k))];
  return sewn;
}

// Flat positions of the skins: as they lie on the table with their outside up.
void lay_flat(PanelLayout& layout, int front_triangles)
{
  for (const Panel& panel : layout.panels) {
    if (panel.is_wall) continue;
    // A panel is a front or a back one as a whole, in the order of the triangles of Sewn.
    const double side = panel.first_triangle < front_triangles ? 1 : -1;
    for (int v = panel.first_vertex; v < panel.first_vertex + panel.vertex_count; ++v) {
      const Vec3 node = layout.nodes.row(layout.node_of[std::size_t(v)]);
      layout.flat.row(v) << side * node.x(), node.y();
    }
  }
}

// The boundary from one of its vertices to another.
std::vector<int> stretch_of(const std::vector<int>& loop, int from, int to)
{
  const auto start = std::find(loop.begin(), loop.end(), from);
  if (start == loop.end() || std::find(loop.begin(), loop.end(), to) == loop.end() || from == to)
    throw InputError(
        fmt::format("a wall from vertex {} to {}: both ends have to be on the sheet's boundary", from, to));
  std::vector<int> rotated(start, loop.end());
  rotated.insert(rotated.end(), loop.begin(), start);
  rotated.push_back(from);
  rotated.erase(std::find(rotated.begin(), rotated.end(), to) + 1, rotated.end());
  return rotated;
}

// Adds the wall between the lines of the front and the back as the last panel of the layout: a column of vertices for
// each of the line's, of one vertex at both ends.
class WallBuilder {
 public:
  WallBuilder(PanelLayout& layout, const Vec& along, const Vec& heights)
      : layout_(layout), along_(along), heights_(heights)
  {
    const double edge = along[along.size() - 1] / double(along.size() - 1);
    rows_ = std::max(1, int(std::lround(heights.maxCoeff() / edge)));
  }

  void build(const std::vector<int>& front, const std::vector<int>& back)
  {
    Panel wall{"wall", true, layout_.vertex_count(), 0, layout_.triangle_count(), 0};
    const int wall_index = int(layout_.panels.size());
    SeamSide top{wall_index, {}}, bottom{wall_index, {}};
    for (std::size_t i = 0; i < front.size(); ++i) {
      columns_.push_back(column(int(i), front[i], back[i]));
      top.vertices.push_back(columns_.back().back());
      bottom.vertices.push_back(columns_.back().front());
      if (i > 0) fill_strip(columns_[i - 1], columns_[i]);
    }
    layout_.triangles.conservativeResize(wall.first_triangle + int(triangles_.size()), 3);
    for (std::size_t t = 0; t < triangles_.size(); ++t)
      for (int k = 0; k < 3; ++k) layout_.triangles(wall.first_triangle + int(t), k) = triangles_[t][std::size_t(k)];
    wall.vertex_count = layout_.vertex_count() - wall.first_vertex;
    wall.triangle_count = int(triangles_.size());
    layout_.panels.push_back(wall);
    layout_.seams[0].sides.push_back(top);
    layout_.seams[1].sides.push_back(bottom);
  }

 private:
  // Bottom (back) to top (front).
  std::vector<int> column(int i, int front, int back)
  {
    if (front == back) return {add_vertex({along_[i], 0}, front)};
    std::vector<int> vertices;
    for (int row = 0; row <= rows_; ++row) {
      const double share = double(row) / rows_;
      int node = row == 0 ? back : front;
      if (row > 0 && row < rows_) {
        node = layout_.node_count();
        layout_.nodes.conservativeResize(node + 1, 3);
        layout_.nodes.row(node) = (1 - share) * layout_.nodes.row(back) + share * layout_.nodes.row(front);
      }
      vertices.push_back(add_vertex({along_[i], heights_[i] * (share - 0.5)}, node));
    }
    return vertices;
  }

  int add_vertex(const Eigen::Vector2d& flat, int node)
  {
    const int v = layout_.vertex_count();
    layout_.node_of.push_back(node);
    layout_.flat.conservativeResize(v + 1, 2);
    layout_.flat.row(v) = flat;
    return v;
  }

  void fill_strip(const std::vector<int>& left, const std::vector<int>& right)
  {
    const bool is_left_point = left.size() == 1, is_right_point = right.size() == 1;
    for (std::size_t row = 0; row < std::size_t(rows_); ++row) {
      if (is_left_point) {
        triangles_.push_back({left[0], right[row], right[row + 1]});
      } else if (is_right_point) {
        triangles_.push_back({left[row], right[0], left[row + 1]});
      } else {
        triangles_.push_back({left[row], right[row], right[row + 1]});
        triangles_.push_back({left[row], right[row + 1], left[row + 1]});
      }
    }
  }

  PanelLayout& layout_;
  const Vec &along_, &heights_;
  int rows_;
  std::vector<std::vector<int>> columns_;
  std::vector<std::array<int, 3>> triangles_;
};

}  // namespace

PanelLayout pillow(const TriangleMesh& sheet)
{
  const Sewn sewn = sew(sheet);
  std::vector<int> rim = sewn.boundary;
  rim.push_back(rim.front());
  PanelLayout layout = split_along(sewn.mesh, {{"rim", 0, rim}});
  lay_flat(layout, sheet.triangle_count());
  layout.panels[0].name = "front";
  layout.panels[1].name = "back";
  return layout;
}

PanelLayout pillow_with_wall(const TriangleMesh& sheet, const std::vector<int>& line, double height, double taper)
{
  if (!(height > 0) || !(taper > 0) || line.size() < 3)
    throw InputError(
        fmt::format("a wall of height {} m and taper {} m along {} vertices: give positive lengths and "
                    "3 vertices or more",
                    height, taper, line.size()));
  const Sewn sewn = sew(sheet);
  std::vector<int> back_line;
  Vec along = Vec::Zero(Eigen::Index(line.size()));
  for (std::size_t i = 0; i < line.size(); ++i) {
    back_line.push_back(sewn.back_of.at(std::size_t(line[i])));
    if (i > 0)
      along[Eigen::Index(i)] =
          along[Eigen::Index(i) - 1] + (sheet.vertices.row(line[i]) - sheet.vertices.row(line[i - 1])).norm();
  }
  const double length = along[along.size() - 1];
  const Vec heights = height * (along.array().min(length - along.array()) / taper).min(1.0);
  PanelLayout layout = split_along(sewn.mesh, {{"front of the wall", 0, line},
                                               {"back of the wall", 0, back_line},
                                               {"rim 1", 0, stretch_of(sewn.boundary, line.front(), line.back())},
                                               {"rim 2", 0, stretch_of(sewn.boundary, line.back(), line.front())}});
  lay_flat(layout, sheet.triangle_count());
  WallBuilder(layout, along, heights).build(line, back_line);
  return layout;
}

PanelLayout triangles_apart(const TriangleMesh& surface)
{
  PanelLayout layout;
  layout.nodes = surface.vertices;
  const int m = surface.triangle_count();
  layout.triangles.resize(m, 3);
  layout.flat.resize(3 * m, 2);
  for (int t = 0; t < m; ++t) {
    const TriangleMesh& s = surface;
    const Vec3 u = s.vertices.row(s.triangles(t, 1)) - s.vertices.row(s.triangles(t, 0));
    const Vec3 v = s.vertices.row(s.triangles(t, 2)) - s.vertices.row(s.triangles(t, 0));
    const double along = u.dot(v) / u.norm();
    layout.triangles.row(t) << 3 * t, 3 * t + 1, 3 * t + 2;
    layout.flat.row(3 * t) << 0, 0;
    layout.flat.row(3 * t + 1) << u.norm(), 0;
    layout.flat.row(3 * t + 2) << along, (v - along * u.normalized()).norm();
    for (int k = 0; k < 3; ++k) layout.node_of.push_back(s.triangles(t, k));
  }
  layout.panels.push_back({"surface", false, 0, 3 * m, 0, m});
  return layout;
}

TriangleMesh spoked_disc(double radius, int spokes, int rings)
{
  if (!(radius > 0) || spokes < 3 || rings < 1)
    throw InputError(fmt::format(
        "a disc of radius {} m with {} spokes and {} rings: give a positive radius, 3 spokes and a ring or more",
        radius, spokes, rings));
  TriangleMesh mesh;
  mesh.vertices.setZero(1 + spokes * rings, 3);
  mesh.triangles.resize(spokes * (2 * rings - 1), 3);
  const auto index = [&](int ring, int spoke) { return ring == 0 ? 0 : 1 + (ring - 1) * spokes + spoke % spokes; };
  Eigen::Index t = 0;
  for (int ring = 1; ring <= rings; ++ring) {
    for (int spoke = 0; spoke < spokes; ++spoke) {
      const double angle = 2 * std::numbers::pi * spoke / spokes, r = radius * ring / rings;
      mesh.vertices.row(index(ring, spoke)) << r * std::cos(angle), r * std::sin(angle), 0;
      mesh.triangles.row(t++) << index(ring - 1, spoke), index(ring, spoke), index(ring, spoke + 1);
      if (ring > 1)
        mesh.triangles.row(t++) << index(ring - 1, spoke), index(ring, spoke + 1), index(ring - 1, spoke + 1);
    }
  }
  return mesh;
}

TriangleMesh rectangle(double width, double height, int columns, int rows)
{
  if (!(width > 0) || !(height > 0) || columns < 1 || rows < 1)
    throw InputError(fmt::format("a rectangle of {} m x {} m in {} x {} cells: give positive numbers", width, height,
                                 columns, rows));
  TriangleMesh mesh;
  mesh.vertices.setZero((columns + 1) * (rows + 1), 3);
  mesh.triangles.resize(2 * columns * rows, 3);
  const auto index = [&](int i, int j) { return i + (columns + 1) * j; };
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i)
      mesh.vertices.row(index(i, j)) << width * (double(i) / columns - 0.5), height * (double(j) / rows - 0.5), 0;
  Eigen::Index t = 0;
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      const int a = index(i, j), b = index(i + 1, j), c = index(i + 1, j + 1), d = index(i, j + 1);
      if ((i + j) % 2 == 0) {
        mesh.triangles.row(t++) << a, b, c;
        mesh.triangles.row(t++) << a, c, d;
      } else {
        mesh.triangles.row(t++) << a, b, d;
        mesh.triangles.row(t++) << b, c, d;
      }
    }
  }
  return mesh;
}

}  // namespace softform
