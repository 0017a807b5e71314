#include "softform/inflatables/panel_remeshing.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include "softform/inflatables/inflatable.hpp"
#include "softform/mesh/polygon.hpp"
#include "softform/mesh/relax.hpp"
#include "softform/mesh/triangulate.hpp"

namespace softform {
namespace {

using Vec2 = Eigen::Vector2d;

Positions in_space(const FlatPositions& flat)
{
  Positions positions = Positions::Zero(flat.rows(), 3);
  positions.leftCols<2>() = flat;
  return positions;
}

/// Lengths of the edges of a chain of old vertices, and places on it: k + s is between its vertices k and k + 1, at the
/// share s.
struct Division {
  std::vector<double> lengths, places;
};

/// Whether edges are neither much longer nor much shorter than wanted.
bool have_length(const std::vector<double>& lengths, double edge_length)
{
  constexpr double largest_ratio = 1.5;
  const auto [shortest, longest] = std::minmax_element(lengths.begin(), lengths.end());
  return *shortest >= edge_length / largest_ratio && *longest <= edge_length * largest_ratio;
}

/// The places of the old vertices.
Division as_it_is(std::vector<double> lengths)
{
  std::vector<double> places(lengths.size() + 1);
  std::iota(places.begin(), places.end(), 0.0);
  return {std::move(lengths), std::move(places)};
}

/// Places that divide a chain into equal parts of about `edge_length`, both ends included. As few as two parts make a
/// panel between two seams, three one within a closed one; where the chain had fewer, so be it.
Division equal_parts(std::vector<double> lengths, bool is_closed, double edge_length)
{
  std::vector<double> up_to{0};
  for (double& length : lengths) {
    length = std::max(length, 1e-9 * edge_length);
    up_to.push_back(up_to.back() + length);
  }
  const int old_count = static_cast<int>(lengths.size());
  const int count = std::max({1, std::min(old_count, is_closed ? 3 : 2),
                              static_cast<int>(std::lround(std::min(up_to.back() / edge_length, 1e6)))});
  Division division{std::move(lengths), {}};
  std::size_t k = 0;
  for (int i = 0; i < count; ++i) {
    const double distance = up_to.back() * i / count;
    while (up_to[k + 1] <= distance && k + 1 < division.lengths.size()) ++k;
    division.places.push_back(static_cast<double>(k) + (distance - up_to[k]) / division.lengths[k]);
  }
  division.places.push_back(old_count);
  return division;
}

/// The value of a chain at its place i, from `value(v)` of its vertices: cubic Hermite segments with the tangents of
/// parabolas through three neighbours (Overhauser 1968), so that a curved boundary does not lose area time and again.
/// All sides of a seam, and its nodes, are interpolated with the same weights.
template <class Value>
auto along(const std::vector<int>& chain, const Division& division, std::size_t i, const Value& value)
    -> decltype(value(0))
{
  using Point = decltype(value(0));
  const std::vector<double>& h = division.lengths;
  const std::size_t k = std::min(static_cast<std::size_t>(division.places[i]), h.size() - 1);
  const double s = division.places[i] - static_cast<double>(k);
  const auto slope = [&](std::size_t j) -> Point { return (value(chain[j + 1]) - value(chain[j])) / h[j]; };
  const auto tangent = [&](std::size_t j) -> Point {
    return (h[j] * slope(j - 1) + h[j - 1] * slope(j)) / (h[j - 1] + h[j]);
  };
  const bool is_first = k == 0, is_last = k + 1 == h.size();
  const Point chord = slope(k);
  Point start = chord, end = chord;
  if (!is_first) start = tangent(k);
  if (!is_last) end = tangent(k + 1);
  if (is_first) start = 2 * chord - end;
  if (is_last && !is_first) end = 2 * chord - start;
  const Point line = (1 - s) * value(chain[k]) + s * value(chain[k + 1]);
  return line + h[k] * s * (1 - s) * ((1 - s) * (start - chord) - s * (end - chord));
}

/// Puts a vertex into the middle of an edge inside.
void halve(PlanarMesh& mesh, const Edge& edge)
{
  const int middle = mesh.vertex_count();
  mesh.positions.conservativeResize(mesh.positions.size() + 2);
  mesh.positions.tail<2>() = (mesh.positions.segment<2>(2 * edge.start) + mesh.positions.segment<2>(2 * edge.end)) / 2;
  const auto has = [](const auto& triangle, int v) { return (triangle.array() == v).any(); };
  const Eigen::Index count = mesh.elements.rows();
  for (Eigen::Index t = 0; t < count; ++t) {
    const Eigen::RowVector3i whole = mesh.elements.row(t);
    if (!has(whole, edge.start) || !has(whole, edge.end)) continue;
    mesh.elements.conservativeResize(mesh.elements.rows() + 1, 3);
    mesh.elements.row(t) = (whole.array() == edge.start).select(middle, whole);
    mesh.elements.bottomRows(1) = (whole.array() == edge.end).select(middle, whole);
  }
}

/// A seam's new vertices: their places on its old ones and their nodes.
struct DividedSeam {
  Division division;
  std::vector<int> nodes;
};

/// A side of a seam as the part of a panel's boundary that starts there.
struct BoundaryPart {
  std::size_t seam, side;
  bool is_forward;  ///< the seam runs the way the boundary does
};

class PanelRemesher {
 public:
  PanelRemesher(const PanelLayout& layout, const Vec& x, const SurfaceDistance& target, double edge_length)
      : old_(layout), X_(flat_vector(layout)), x_(x), target_(target), edge_length_(edge_length)
  {}

  std::optional<RemeshedPanels> result()
  {
    for (const Seam& seam : old_.seams) divide(seam);
    for (std::size_t p = 0; p < old_.panels.size(); ++p)
      if (!remesh(static_cast<int>(p))) return std::nullopt;
    PanelLayout& layout = new_.layout;
    const auto n = static_cast<Eigen::Index>(targets_.size());
    layout.nodes.resize(n, 3);
    new_.x.resize(3 * n);
    for (Eigen::Index i = 0; i < n; ++i) {
      layout.nodes.row(i) = targets_[static_cast<std::size_t>(i)];
      new_.x.segment<3>(3 * i) = inflated_[static_cast<std::size_t>(i)];
    }
    layout.flat.resize(layout.vertex_count(), 2);
    for (Eigen::Index v = 0; v < layout.flat.rows(); ++v) layout.flat.row(v) = flat_[static_cast<std::size_t>(v)];
    layout.triangles.resize(static_cast<Eigen::Index>(triangles_.size()), 3);
    for (Eigen::Index t = 0; t < layout.triangles.rows(); ++t)
      layout.triangles.row(t) = triangles_[static_cast<std::size_t>(t)];
    return std::move(new_);
  }

 private:
  int old_node(int vertex) const { return old_.node_of[static_cast<std::size_t>(vertex)]; }
  Vec2 old_flat(int vertex) const { return old_.flat.row(vertex); }
  Vec3 old_target(int vertex) const { return old_.nodes.row(old_node(vertex)); }
  Vec3 old_inflated(int vertex) const { return softform::vertex(x_, old_node(vertex)); }
  double old_length(int a, int b) const { return (old_flat(b) - old_flat(a)).norm(); }

  int add_node(const Vec3& target, const Vec3& inflated, bool is_on_target)
  {
    targets_.push_back(is_on_target ? target_.closest(target).position : target);
    inflated_.push_back(inflated);
    return static_cast<int>(targets_.size()) - 1;
  }

  /// The new node of an old one that stays as it is.
  int kept_node(int vertex)
  {
    const auto [it, is_new] = kept_nodes_.try_emplace(old_node(vertex), -1);
    if (is_new) it->second = add_node(old_target(vertex), old_inflated(vertex), false);
    return it->second;
  }

  int node_along(const std::vector<int>& chain, const Division& division, std::size_t i, bool is_on_target)
  {
    return add_node(along(chain, division, i, [&](int v) { return old_target(v); }),
                    along(chain, division, i, [&](int v) { return old_inflated(v); }), is_on_target);
  }

  /// Equal parts, but for a seam that is held on the target where its edges will do: new ones bend it where its old
  /// ones did not, and the shape with it. One that slides would end with all its vertices in one place.
  Division division(const Seam& seam, std::vector<double> lengths) const
  {
    if (seam.weight > 0 && have_length(lengths, edge_length_)) return as_it_is(std::move(lengths));
    const std::vector<int>& chain = seam.sides[0].vertices;
    return equal_parts(std::move(lengths), old_node(chain.front()) == old_node(chain.back()), edge_length_);
  }

  void divide(const Seam& seam)
  {
    const std::vector<int>& chain = seam.sides[0].vertices;
    std::vector<double> lengths(chain.size() - 1, 0);
    for (const SeamSide& side : seam.sides)
      for (std::size_t k = 0; k < lengths.size(); ++k)
        lengths[k] += old_length(side.vertices[k], side.vertices[k + 1]) / static_cast<double>(seam.sides.size());
    DividedSeam divided{division(seam, std::move(lengths)), {}};
    const std::size_t count = divided.division.places.size();
    divided.nodes.push_back(kept_node(chain.front()));
    for (std::size_t i = 1; i + 1 < count; ++i) divided.nodes.push_back(node_along(chain, divided.division, i, true));
    divided.nodes.push_back(kept_node(chain.back()));
    new_.layout.seams.push_back({seam.name, seam.weight, {}});
    for (const SeamSide& side : seam.sides)
      new_.layout.seams.back().sides.push_back({side.panel, std::vector<int>(count, -1)});
    for (std::size_t i = 1; i < divided.nodes.size(); ++i)
      joined_.insert(std::minmax(divided.nodes[i - 1], divided.nodes[i]));
    divided_.push_back(std::move(divided));
  }

  /// The sides of seams along a panel's boundary, by the place in the loop where they start.
  std::map<std::size_t, BoundaryPart> parts_of(const std::vector<int>& loop, int panel) const
  {
    std::map<int, std::size_t> place;
    for (std::size_t i = 0; i < loop.size(); ++i) place[loop[i]] = i;
    std::map<std::size_t, BoundaryPart> parts;
    for (std::size_t s = 0; s < old_.seams.size(); ++s) {
      for (std::size_t k = 0; k < old_.seams[s].sides.size(); ++k) {
        const SeamSide& side = old_.seams[s].sides[k];
        if (side.panel != panel) continue;
        const bool is_forward = loop[(place.at(side.vertices[0]) + 1) % loop.size()] == side.vertices[1];
        parts[place.at(is_forward ? side.vertices.front() : side.vertices.back())] = {s, k, is_forward};
      }
    }
    return parts;
  }

  void add_vertex(const Vec2& flat, int node)
  {
    flat_.push_back(flat);
    new_.layout.node_of.push_back(node);
  }

  /// Adds a side's vertices but the last one, which is the first of the next part, or the panel's first.
  void add_side(const BoundaryPart& part)
  {
    const DividedSeam& divided = divided_[part.seam];
    const std::vector<int>& chain = old_.seams[part.seam].sides[part.side].vertices;
    std::vector<int>& vertices = new_.layout.seams[part.seam].sides[part.side].vertices;
    const std::size_t last = divided.nodes.size() - 1;
    for (std::size_t i = 0; i < last; ++i) {
      const std::size_t k = part.is_forward ? i : last - i;
      vertices[k] = new_.layout.vertex_count();
      add_vertex(along(chain, divided.division, k, [&](int v) { return old_flat(v); }), divided.nodes[k]);
    }
    vertices[part.is_forward ? last : 0] = new_.layout.vertex_count();
  }

  /// The same of a part that is sewn to nothing.
  void add_free(const std::vector<int>& chain, bool is_on_target)
  {
    std::vector<double> lengths;
    for (std::size_t k = 0; k + 1 < chain.size(); ++k) lengths.push_back(old_length(chain[k], chain[k + 1]));
    const Division parts = equal_parts(std::move(lengths), chain.front() == chain.back(), edge_length_);
    for (std::size_t i = 0; i + 1 < parts.places.size(); ++i)
      add_vertex(along(chain, parts, i, [&](int v) { return old_flat(v); }),
                 i == 0 ? kept_node(chain.front()) : node_along(chain, parts, i, is_on_target));
  }

  void add_boundary(int panel, int first_vertex)
  {
    const std::vector<int> loop = boundary_loops(old_, panel).front();
    const auto parts = parts_of(loop, panel);
    const std::size_t start = parts.empty() ? 0 : parts.begin()->first;
    std::vector<int> free{loop[start]};
    for (std::size_t i = 0; i < loop.size();) {
      const std::size_t here = (start + i) % loop.size();
      const auto part = parts.find(here);
      if (part != parts.end()) {
        add_side(part->second);
        i += old_.seams[part->second.seam].sides[part->second.side].vertices.size() - 1;
        free = {loop[(start + i) % loop.size()]};
        continue;
      }
      ++i;
      free.push_back(loop[(start + i) % loop.size()]);
      if (i == loop.size() || parts.count((start + i) % loop.size()) > 0)
        add_free(free, !old_.panels[static_cast<std::size_t>(panel)].is_wall);
    }
    // The last part ends where the first one starts.
    for (Seam& seam : new_.layout.seams)
      for (SeamSide& side : seam.sides)
        if (side.panel == panel)
          std::replace(side.vertices.begin(), side.vertices.end(), new_.layout.vertex_count(), first_vertex);
  }

  bool remesh(int index)
  {
    Panel panel = old_.panels[static_cast<std::size_t>(index)];
    const Panel was = panel;
    panel.first_vertex = new_.layout.vertex_count();
    panel.first_triangle = static_cast<int>(triangles_.size());
    add_boundary(index, panel.first_vertex);
    FlatPositions polygon(new_.layout.vertex_count() - panel.first_vertex, 2);
    for (Eigen::Index i = 0; i < polygon.rows(); ++i)
      polygon.row(i) = flat_[static_cast<std::size_t>(panel.first_vertex + i)];
    if (!polygon.allFinite() || !is_simple(polygon) || !(signed_area(polygon) > 0)) return false;

    PlanarMesh mesh = triangulate_inside(polygon, edge_length_);
    halve_repeated_edges(mesh, panel.first_vertex, static_cast<int>(polygon.rows()));
    add_interior(was, rows_of(mesh.positions).bottomRows(mesh.vertex_count() - polygon.rows()));
    for (const auto& triangle : mesh.elements.rowwise()) triangles_.emplace_back(triangle.array() + panel.first_vertex);
    panel.vertex_count = mesh.vertex_count();
    panel.triangle_count = mesh.element_count();
    new_.layout.panels.push_back(std::move(panel));
    return true;
  }

  /// Two nodes on seams are joined by one edge at most: where panels on both sides of a corner would cut it off, or one
  /// panel the tip of its dart, their triangles would lie on each other, or on a line.
  void halve_repeated_edges(PlanarMesh& mesh, int first_vertex, int boundary_count)
  {
    const auto node = [&](int i) { return new_.layout.node_of[static_cast<std::size_t>(first_vertex + i)]; };
    for (const Edge& edge : edges_of(mesh.elements, mesh.vertex_count())) {
      if (edge.right < 0 || edge.start >= boundary_count || edge.end >= boundary_count) continue;
      const int a = node(edge.start), b = node(edge.end);
      if (a == b || !joined_.insert(std::minmax(a, b)).second) halve(mesh, edge);
    }
  }

  void add_interior(const Panel& panel, const FlatPositions& points)
  {
    const Triangles upright = upright_triangles(panel);
    const SurfaceDistance old_panel({in_space(old_.flat), upright});
    for (const auto& point : points.rowwise()) {
      const ClosestPoint found = old_panel.closest({point.x(), point.y(), 0});
      const Eigen::RowVector3i triangle = upright.row(found.triangle);
      const Vec3 share = barycentric(triangle, found.position.head<2>());
      Vec3 target = Vec3::Zero(), inflated = Vec3::Zero();
      for (int k = 0; k < 3; ++k) {
        target += share[k] * old_target(triangle[k]);
        inflated += share[k] * old_inflated(triangle[k]);
      }
      add_vertex(point, add_node(target, inflated, !panel.is_wall));
    }
  }

  /// Where triangles are folded over each other the upright ones still cover the inside of the boundary: each of its
  /// points is under one more of them than under triangles that are turned over.
  Triangles upright_triangles(const Panel& panel) const
  {
    Triangles upright(panel.triangle_count, 3);
    Eigen::Index count = 0;
    for (int t = panel.first_triangle; t < panel.first_triangle + panel.triangle_count; ++t)
      if (doubled_area(X_, old_.triangles, t) > 0) upright.row(count++) = old_.triangles.row(t);
    return upright.topRows(count);
  }

  Vec3 barycentric(const Eigen::RowVector3i& triangle, const Vec2& point) const
  {
    Vec3 share;
    for (int k = 0; k < 3; ++k) {
      const Vec2 a = old_flat(triangle[(k + 1) % 3]) - point, b = old_flat(triangle[(k + 2) % 3]) - point;
      share[k] = std::max(a.x() * b.y() - a.y() * b.x(), 0.0);
    }
    return share / share.sum();
  }

  const PanelLayout& old_;
  const Vec X_;
  const Vec& x_;
  const SurfaceDistance& target_;
  double edge_length_;

  RemeshedPanels new_;
  std::vector<DividedSeam> divided_;
  std::map<int, int> kept_nodes_;
  std::set<std::pair<int, int>> joined_;  // nodes of seams between which there is an edge
  std::vector<Vec3> targets_, inflated_;
  std::vector<Vec2> flat_;
  std::vector<Eigen::RowVector3i> triangles_;
};

/// The edge of the equilateral triangles that cover the panels with as many as there are.
double mean_edge_length(const PanelLayout& layout)
{
  double area = 0;
  for (int p = 0; p < static_cast<int>(layout.panels.size()); ++p) {
    const std::vector<int> loop = boundary_loops(layout, p).front();
    area += std::abs(signed_area(layout.flat(loop, Eigen::all)));
  }
  return std::sqrt(4 / std::sqrt(3.0) * area / layout.triangle_count());
}

}  // namespace

bool needs_remeshing(const PanelLayout& layout, const PanelRemeshingOptions& options)
{
  return !(flat_quality(layout).minCoeff<Eigen::PropagateNaN>() >= options.quality_threshold);
}

std::optional<RemeshedPanels> remeshed(const PanelLayout& layout, const Vec& x, const SurfaceDistance& target,
                                       const PanelRemeshingOptions& options)
{
  if (!layout.flat.allFinite() || !x.allFinite()) return std::nullopt;
  const auto with_edges = [&](double length) { return PanelRemesher(layout, x, target, length).result(); };
  if (options.edge_length > 0) return with_edges(options.edge_length);
  const double edge_length = mean_edge_length(layout);
  if (!(edge_length > 0)) return std::nullopt;
  // Rounded counts of edges on short seams show in the number of triangles: a second go makes up for that.
  const auto first = with_edges(edge_length);
  if (!first) return std::nullopt;
  return with_edges(edge_length * std::sqrt(double(first->layout.triangle_count()) / layout.triangle_count()));
}

PanelLayout with_triangles(const PanelLayout& layout, const SurfaceDistance& target, int count)
{
  constexpr int rounds = 3;  // of correcting the length of edges
  PanelRemeshingOptions options;
  const double area = surface_area(flatten(layout.nodes), node_triangles(layout));
  options.edge_length = std::sqrt(4 / std::sqrt(3.0) * area / count);
  PanelLayout result = layout;
  for (int round = 0; round < rounds; ++round) {
    auto anew = remeshed(layout, flatten(layout.nodes), target, options);
    if (!anew) break;
    result = std::move(anew->layout);
    options.edge_length *= std::sqrt(double(result.triangle_count()) / count);
  }
  return result;
}

}  // namespace softform
