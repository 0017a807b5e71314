#include "softform/mesh/region_surface.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include <Eigen/Geometry>

#include "softform/mesh/disjoint_sets.hpp"

namespace softform {
namespace {

using Face = std::array<int, 3>;

Face sorted(int a, int b, int c)
{
  Face face{a, b, c};
  std::sort(face.begin(), face.end());
  return face;
}

// A surface by its half-edges: number 3 t + k runs from corner k of triangle t to the next one; `mates` are the ones
// that run back.
class HalfEdges {
 public:
  HalfEdges(const SimplexMesh<3>& region, const BoundaryFaces<3>& boundary);

  int triangle_count() const { return static_cast<int>(corners_.size()); }
  int origin(int h) const { return corners_[std::size_t(h / 3)][std::size_t(h % 3)]; }
  int tip(int h) const { return origin(next(h)); }
  int mate(int h) const { return mates_[std::size_t(h)]; }
  static int next(int h) { return h % 3 == 2 ? h - 2 : h + 1; }
  void set_origin(int h, int vertex) { corners_[std::size_t(h / 3)][std::size_t(h % 3)] = vertex; }

  /// Puts a vertex on an edge and halves its two triangles. `h` is the number that the edge had before any was halved.
  void halve(int h, int vertex);
  Triangles triangles() const;

 private:
  void join(int h, int g)
  {
    mates_[std::size_t(h)] = g;
    mates_[std::size_t(g)] = h;
  }
  // Cuts the corner at the tip of h off; returns the half-edge to the old tip.
  int cut(int h, int vertex);

  std::vector<Face> corners_;
  std::vector<int> mates_;
  std::map<int, int> renumbered_;  // half-edges that went to another triangle
};

// From a boundary face around one of its edges, through the region, to the face where the wedge ends.
HalfEdges::HalfEdges(const SimplexMesh<3>& region, const BoundaryFaces<3>& boundary)
    : mates_(3 * boundary.elements.size(), -1)
{
  const Tetrahedra& elements = region.elements;
  std::map<Face, std::vector<int>> owners;
  for (int e = 0; e < elements.rows(); ++e)
    for (int k = 0; k < 4; ++k)
      owners[sorted(elements(e, (k + 1) % 4), elements(e, (k + 2) % 4), elements(e, (k + 3) % 4))].push_back(e);
  std::map<Face, int> number;
  for (Eigen::Index f = 0; f < boundary.faces.rows(); ++f) {
    corners_.push_back({boundary.faces(f, 0), boundary.faces(f, 1), boundary.faces(f, 2)});
    number[sorted(corners_.back()[0], corners_.back()[1], corners_.back()[2])] = static_cast<int>(f);
  }
  for (int h = 0; h < static_cast<int>(mates_.size()); ++h) {
    const int a = origin(h), b = tip(h);
    int opposite = tip(next(h)), element = boundary.elements[std::size_t(h / 3)];
    Face face;
    for (;;) {
      const auto corners = elements.row(element);
      opposite = corners.sum() - a - b - opposite;
      face = sorted(a, b, opposite);
      const std::vector<int>& both = owners.at(face);
      if (both.size() == 1) break;
      element = both[0] == element ? both[1] : both[0];
    }
    const int f = number.at(face);
    for (int k = 0; k < 3; ++k)
      if (origin(3 * f + k) == b && tip(3 * f + k) == a) mates_[std::size_t(h)] = 3 * f + k;
  }
}

int HalfEdges::cut(int h, int vertex)
{
  const int onwards = next(h), back = next(onwards), t = triangle_count();
  corners_.push_back({vertex, tip(h), origin(back)});
  mates_.resize(mates_.size() + 3, -1);
  join(3 * t + 1, mate(onwards));
  renumbered_[onwards] = 3 * t + 1;
  join(3 * t + 2, onwards);
  set_origin(onwards, vertex);
  return 3 * t;
}

void HalfEdges::halve(int h, int vertex)
{
  const auto now = renumbered_.find(h);
  if (now != renumbered_.end()) h = now->second;
  const int g = mate(h);
  const int rest_of_h = cut(h, vertex), rest_of_g = cut(g, vertex);
  join(h, rest_of_g);
  join(g, rest_of_h);
}

Triangles HalfEdges::triangles() const
{
  Triangles result(triangle_count(), 3);
  for (int h = 0; h < 3 * triangle_count(); ++h) result(h / 3, h % 3) = origin(h);
  return result;
}

class Splitter {
 public:
  Splitter(const SimplexMesh<3>& region, const ContactOptions& options)
      : region_(region),
        options_(options),
        boundary_(boundary_faces<3>(region.elements)),
        surface_(region, boundary_),
        normals_(boundary_.faces.rows(), 3)
  {
    for (Eigen::Index f = 0; f < normals_.rows(); ++f) {
      const Vec3 a = point(boundary_.faces(f, 0));
      normals_.row(f) = (point(boundary_.faces(f, 1)) - a).cross(point(boundary_.faces(f, 2)) - a).normalized();
    }
  }

  RegionSurface run()
  {
    split_vertices();
    halve_edges();
    result_.mesh.vertices.resize(Eigen::Index(positions_.size()), 3);
    for (std::size_t i = 0; i < positions_.size(); ++i)
      result_.mesh.vertices.row(Eigen::Index(i)) = positions_[i].transpose();
    result_.mesh.triangles = surface_.triangles();
    return std::move(result_);
  }

 private:
  // A fan of triangles around a vertex: the half-edges that leave from it.
  using Fan = std::vector<int>;

  Vec3 point(int vertex) const { return region_.positions.segment<3>(3 * Eigen::Index(vertex)); }
  void split_vertices();
  std::map<int, int> parts_around(int vertex) const;
  void separate(int vertex, const std::vector<Fan>& fans);
  Vec3 towards_inside(int vertex, const std::set<int>& elements) const;
  double angle_of(const Fan& fan) const;
  Vec3 moved(const Vec3& from, Vec3 direction, double shortest_edge) const;
  void halve_edges();

  const SimplexMesh<3>& region_;
  const ContactOptions& options_;
  BoundaryFaces<3> boundary_;
  HalfEdges surface_;
  Positions normals_;
  std::vector<std::vector<int>> elements_of_;  // of every vertex
  std::vector<Vec3> positions_;                // of the surface's vertices
  RegionSurface result_;
};

// One surface vertex for each fan.
void Splitter::split_vertices()
{
  elements_of_.resize(std::size_t(region_.vertex_count()));
  for (int e = 0; e < region_.element_count(); ++e)
    for (int k = 0; k < 4; ++k) elements_of_[std::size_t(region_.elements(e, k))].push_back(e);
  std::map<int, std::vector<Fan>> fans;
  std::vector<bool> is_seen(std::size_t(3 * surface_.triangle_count()), false);
  for (int h = 0; h < 3 * surface_.triangle_count(); ++h) {
    if (is_seen[std::size_t(h)]) continue;
    Fan fan;
    for (int at = h; !is_seen[std::size_t(at)]; at = HalfEdges::next(surface_.mate(at))) {
      is_seen[std::size_t(at)] = true;
      fan.push_back(at);
    }
    fans[surface_.origin(h)].push_back(std::move(fan));
  }
  std::map<int, int> first_copy;
  for (const auto& [vertex, list] : fans) {
    first_copy[vertex] = static_cast<int>(positions_.size());
    positions_.insert(positions_.end(), list.size(), point(vertex));
    if (list.size() == 1) continue;
    ++result_.split_vertices;
    separate(vertex, list);
  }
  for (const auto& [vertex, list] : fans)
    for (std::size_t i = 0; i < list.size(); ++i)
      for (const int h : list[i]) surface_.set_origin(h, first_copy[vertex] + static_cast<int>(i));
}

// The parts of the region around a vertex that hang together by faces: a number for every element.
std::map<int, int> Splitter::parts_around(int vertex) const
{
  const std::vector<int>& elements = elements_of_[std::size_t(vertex)];
  DisjointSets sets(elements.size());
  std::map<Face, int> seen;
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const auto corners = region_.elements.row(elements[i]);
    for (int k = 0; k < 4; ++k) {
      if (corners[k] == vertex) continue;  // the face opposite to it is not around the vertex
      const Face face = sorted(corners[(k + 1) % 4], corners[(k + 2) % 4], corners[(k + 3) % 4]);
      const auto [at, is_new] = seen.try_emplace(face, static_cast<int>(i));
      if (!is_new) sets.unite(static_cast<int>(i), at->second);
    }
  }
  std::map<int, int> part;
  for (std::size_t i = 0; i < elements.size(); ++i) part[elements[i]] = sets.root(static_cast<int>(i));
  return part;
}

// Tips that touch are drawn back into their own part. Hollows that touch inside one part are drawn back into the
// hollow, all but the widest.
void Splitter::separate(int vertex, const std::vector<Fan>& fans)
{
  const std::size_t first_copy = positions_.size() - fans.size();
  const std::map<int, int> part = parts_around(vertex);
  std::map<int, std::vector<std::size_t>> fans_of_part;
  for (std::size_t i = 0; i < fans.size(); ++i)
    fans_of_part[part.at(boundary_.elements[std::size_t(fans[i][0] / 3)])].push_back(i);
  for (auto& [number, members] : fans_of_part) {
    std::set<int> elements;
    for (const auto& [element, of] : part)
      if (of == number) elements.insert(element);
    const auto wider = [&](std::size_t a, std::size_t b) { return angle_of(fans[a]) > angle_of(fans[b]); };
    std::sort(members.begin(), members.end(), wider);
    for (std::size_t k = members.size() == 1 ? 0 : 1; k < members.size(); ++k) {
      const Fan& fan = fans[members[k]];
      Vec3 outwards = Vec3::Zero();
      double shortest = std::numeric_limits<double>::infinity();
      for (const int h : fan) {
        outwards += normals_.row(h / 3);
        shortest = std::min(shortest, (point(surface_.tip(h)) - point(vertex)).norm());
      }
      Vec3& copy = positions_[first_copy + members[k]];
      copy = moved(copy, members.size() == 1 ? towards_inside(vertex, elements) : outwards, shortest);
    }
  }
}

Vec3 Splitter::towards_inside(int vertex, const std::set<int>& elements) const
{
  Vec3 sum = Vec3::Zero();
  for (const int e : elements)
    for (const int corner : region_.elements.row(e))
      if (corner != vertex) sum += (point(corner) - point(vertex)).normalized();
  return sum;
}

double Splitter::angle_of(const Fan& fan) const
{
  double sum = 0;
  for (const int h : fan) {
    const Vec3 at = point(surface_.origin(h));
    const Vec3 a = point(surface_.tip(h)) - at, b = point(surface_.tip(HalfEdges::next(h))) - at;
    sum += std::atan2(a.cross(b).norm(), a.dot(b));
  }
  return sum;
}

Vec3 Splitter::moved(const Vec3& from, Vec3 direction, double shortest_edge) const
{
  if (options_.keeps_height) direction.z() = 0;
  const double length = direction.norm();
  return length > 0 ? Vec3(from + std::min(options_.gap / 2, shortest_edge / 20) / length * direction) : from;
}

// Edges with the same two ends, each drawn back into its own wedge.
void Splitter::halve_edges()
{
  std::map<std::pair<int, int>, std::vector<int>> copies;
  for (int h = 0; h < 3 * surface_.triangle_count(); ++h)
    if (h < surface_.mate(h)) copies[std::minmax(surface_.origin(h), surface_.tip(h))].push_back(h);
  std::vector<std::pair<int, int>> halves;  // half-edge and its new vertex
  for (const auto& [ends, list] : copies) {
    if (list.size() == 1) continue;
    ++result_.split_edges;
    const Vec3 a = positions_[std::size_t(ends.first)], b = positions_[std::size_t(ends.second)];
    for (const int h : list) {
      const Vec3 outwards = normals_.row(h / 3) + normals_.row(surface_.mate(h) / 3);
      halves.emplace_back(h, static_cast<int>(positions_.size()));
      positions_.push_back(moved((a + b) / 2, -outwards, (b - a).norm()));
    }
  }
  for (const auto& [h, vertex] : halves) surface_.halve(h, vertex);
}

}  // namespace

RegionSurface region_surface(const SimplexMesh<3>& body, const std::vector<bool>& is_inside,
                             const ContactOptions& options)
{
  std::vector<int> chosen;
  for (std::size_t e = 0; e < is_inside.size(); ++e)
    if (is_inside[e]) chosen.push_back(static_cast<int>(e));
  return Splitter({body.positions, body.elements(chosen, Eigen::all)}, options).run();
}

}  // namespace softform
