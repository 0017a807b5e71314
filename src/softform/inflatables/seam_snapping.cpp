#include "softform/inflatables/seam_snapping.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <set>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "softform/core/error.hpp"
#include "softform/mesh/relax.hpp"

namespace softform {
namespace {

/// How far from a seam its chain may pass, in edge lengths, and how much longer a detour off the seam counts.
constexpr double band = 1.5;
constexpr double detour_weight = 30;
/// The chains move to their seams in small steps, so that no triangle turns over; then the mesh settles.
constexpr int move_steps = 6, rounds_per_step = 2, settling_rounds = 20;
/// Triangles worse than this are no basis for a simulation.
constexpr double least_quality = 0.1;

constexpr double infinity = std::numeric_limits<double>::infinity();

std::pair<int, int> sorted(int a, int b) { return std::minmax(a, b); }

double distance_to_polyline(const Vec3& p, const Positions& points)
{
  double least = infinity;
  for (Eigen::Index i = 0; i + 1 < points.rows(); ++i) {
    const Vec3 a = points.row(i), ab = points.row(i + 1) - points.row(i);
    const double t = std::clamp((p - a).dot(ab) / std::max(ab.squaredNorm(), 1e-300), 0.0, 1.0);
    least = std::min(least, (a + t * ab - p).norm());
  }
  return least;
}

/// Finds edge-disjoint chains along the segments, one after the other.
class ChainFinder {
 public:
  ChainFinder(const TriangleMesh& mesh, const Geodesics& target, const SeamNetwork& network, const SeamPlan& plan)
      : mesh_(mesh),
        target_(target),
        network_(network),
        plan_(plan),
        edge_length_(mean_edge_length(mesh)),
        neighbours_(vertex_neighbours(mesh.triangles, mesh.vertex_count())),
        normals_(vertex_normals(flatten(mesh.vertices), mesh.triangles)),
        is_taken_(static_cast<std::size_t>(mesh.vertex_count()), false)
  {}

  std::vector<SeamChain> find()
  {
    for (Eigen::Index i = 0; i < network_.nodes.rows(); ++i)
      node_vertices_.push_back(take_closest(network_.nodes.row(i)));
    std::vector<SeamChain> chains;
    for (const SeamSegment& segment : network_.segments)
      chains.push_back(
          {segment.name, plan_.seams[static_cast<std::size_t>(segment.seam)].weight, chain_along(segment)});
    return chains;
  }

 private:
  [[noreturn]] void refuse(const SeamSegment& segment, const Vec3& p) const
  {
    throw InputError(
        fmt::format("{}: seam '{}' finds no free edges near {}: other seams are too close for triangles of "
                    "edge length {:.3g}; move the seams apart or ask for more vertices",
                    plan_.source, segment.name, place(p), edge_length_));
  }

  int take_closest(const Vec3& p)
  {
    int closest = -1;
    double least = infinity;
    for (int v = 0; v < mesh_.vertex_count(); ++v) {
      const double distance = (mesh_.vertices.row(v).transpose() - p).norm();
      if (!is_taken_[static_cast<std::size_t>(v)] && distance < least) least = distance, closest = v;
    }
    if (least > 1.5 * edge_length_)
      throw InputError(
          fmt::format("{}: there is no free vertex for the end of a seam at {}: seams meet too closely "
                      "there; move them apart or ask for more vertices",
                      plan_.source, place(p)));
    is_taken_[static_cast<std::size_t>(closest)] = true;
    return closest;
  }

  std::vector<int> chain_along(const SeamSegment& segment)
  {
    // A closed chain is found in three parts.
    std::vector<int> stops{node_vertices_[static_cast<std::size_t>(segment.start)]};
    if (segment.start == segment.end) {
      const Vec arcs = arc_lengths(segment.points);
      for (const double part : {1.0 / 3, 2.0 / 3})
        stops.push_back(take_closest(point_at(segment.points, arcs, part * arcs[arcs.size() - 1])));
    }
    stops.push_back(node_vertices_[static_cast<std::size_t>(segment.end)]);

    std::vector<int> chain{stops.front()};
    for (std::size_t i = 0; i + 1 < stops.size(); ++i) {
      const std::vector<int> part = shortest_path(segment, stops[i], stops[i + 1]);
      chain.insert(chain.end(), part.begin() + 1, part.end());
    }
    shorten(chain);
    for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
      is_taken_[static_cast<std::size_t>(chain[i])] = true;
      taken_edges_.insert(sorted(chain[i], chain[i + 1]));
    }
    return chain;
  }

  /// Infinite for vertices on another side of the target than the seam, as in thin parts.
  double distance(const SeamSegment& segment, int v) const
  {
    const Vec3 p = mesh_.vertices.row(v);
    const double d = distance_to_polyline(p, segment.points);
    if (d > band * edge_length_) return infinity;
    Eigen::Index closest;
    (segment.points.rowwise() - p.transpose()).rowwise().squaredNorm().minCoeff(&closest);
    const Vec3 normal = target_.surface().closest(segment.points.row(closest)).normal;
    return normal.dot(normals_.row(v)) > 0 ? d : infinity;
  }

  /// Dijkstra with edges that are the longer, the farther they are from the seam.
  std::vector<int> shortest_path(const SeamSegment& segment, int start, int end) const
  {
    const auto count = static_cast<std::size_t>(mesh_.vertex_count());
    std::vector<double> off_seam(count, -1), cost(count, infinity);
    std::vector<int> previous(count, -1);
    std::priority_queue<std::pair<double, int>, std::vector<std::pair<double, int>>, std::greater<>> queue;
    cost[static_cast<std::size_t>(start)] = 0;
    off_seam[static_cast<std::size_t>(start)] = distance_to_polyline(mesh_.vertices.row(start), segment.points);
    queue.emplace(0, start);
    while (!queue.empty()) {
      const auto [so_far, v] = queue.top();
      queue.pop();
      if (v == end) break;
      if (so_far > cost[static_cast<std::size_t>(v)]) continue;
      for (const int w : neighbours_[static_cast<std::size_t>(v)]) {
        const auto index = static_cast<std::size_t>(w);
        if ((is_taken_[index] && w != end) || taken_edges_.count(sorted(v, w)) > 0) continue;
        if (off_seam[index] < 0)
          off_seam[index] =
              w == end ? distance_to_polyline(mesh_.vertices.row(w), segment.points) : distance(segment, w);
        if (off_seam[index] == infinity) continue;
        const Vec3 middle = 0.5 * (mesh_.vertices.row(v) + mesh_.vertices.row(w));
        const double d0 = off_seam[static_cast<std::size_t>(v)], d1 = off_seam[index],
                     dm = distance_to_polyline(middle, segment.points);
        const double mean_square = (d0 * d0 + 4 * dm * dm + d1 * d1) / 6;
        const double length = (mesh_.vertices.row(v) - mesh_.vertices.row(w)).norm();
        const double total = so_far + length * (1 + detour_weight * mean_square / (edge_length_ * edge_length_));
        if (total < cost[index]) {
          cost[index] = total;
          previous[index] = v;
          queue.emplace(total, w);
        }
      }
    }
    if (previous[static_cast<std::size_t>(end)] < 0) refuse(segment, segment.points.row(segment.points.rows() / 2));
    std::vector<int> path{end};
    while (path.back() != start) path.push_back(previous[static_cast<std::size_t>(path.back())]);
    std::reverse(path.begin(), path.end());
    return path;
  }

  bool are_neighbours(int v, int w) const
  {
    const auto& list = neighbours_[static_cast<std::size_t>(v)];
    return std::binary_search(list.begin(), list.end(), w);
  }

  /// Drops vertices that an edge passes by: three of a triangle on one seam would make it flat.
  void shorten(std::vector<int>& chain) const
  {
    const bool is_closed = chain.front() == chain.back();
    for (std::size_t i = 1; i + 1 < chain.size();) {
      const bool can_go = chain.size() > (is_closed ? 4U : 2U) && are_neighbours(chain[i - 1], chain[i + 1]) &&
                          taken_edges_.count(sorted(chain[i - 1], chain[i + 1])) == 0;
      if (can_go)
        chain.erase(chain.begin() + static_cast<std::ptrdiff_t>(i));
      else
        ++i;
    }
  }

  const TriangleMesh& mesh_;
  const Geodesics& target_;
  const SeamNetwork& network_;
  const SeamPlan& plan_;
  double edge_length_;
  std::vector<std::vector<int>> neighbours_;
  Positions normals_;
  std::vector<bool> is_taken_;
  std::set<std::pair<int, int>> taken_edges_;
  std::vector<int> node_vertices_;
};

void require_room(const TriangleMesh& mesh, const Geodesics& target, const SeamPlan& plan)
{
  const Vec x = flatten(mesh.vertices);
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    const Vec3 a = mesh.vertices.row(mesh.triangles(t, 0)), b = mesh.vertices.row(mesh.triangles(t, 1)),
               c = mesh.vertices.row(mesh.triangles(t, 2));
    const Vec3 middle = (a + b + c) / 3;
    const double quality = smallest_quality(x, mesh.triangles.row(t));
    const bool is_upright = (b - a).cross(c - a).dot(target.surface().closest(middle).normal) > 0;
    if (!(quality >= least_quality) || !is_upright)
      throw InputError(
          fmt::format("{}: the seams near {} leave no room for well-shaped triangles of edge length {:.3g}: "
                      "move them apart or ask for more vertices",
                      plan.source, place(middle), mean_edge_length(mesh)));
  }
}

}  // namespace

SeamedMesh snap_to_seams(const TriangleMesh& mesh, const Geodesics& target, const SeamNetwork& network,
                         const SeamPlan& plan)
{
  SeamedMesh result{mesh, ChainFinder(mesh, target, network, plan).find()};
  std::vector<std::pair<int, int>> seam_edges;
  std::vector<std::pair<int, Vec3>> moves;  // of chain vertices to their seams
  for (std::size_t s = 0; s < result.chains.size(); ++s) {
    const std::vector<int>& chain = result.chains[s].vertices;
    const Positions goals = resampled(network.segments[s].points, static_cast<int>(chain.size()));
    for (std::size_t i = 0; i < chain.size(); ++i) {
      if (i + 1 < chain.size()) seam_edges.emplace_back(chain[i], chain[i + 1]);
      moves.emplace_back(chain[i], goals.row(static_cast<Eigen::Index>(i)));
    }
  }
  const auto onto_target = [&](const Vec3& p) { return target.surface().closest(p).position; };
  for (int step = move_steps; step > 0; --step) {
    for (const auto& [v, goal] : moves) {
      const Vec3 p = result.mesh.vertices.row(v);
      result.mesh.vertices.row(v) = onto_target(p + (goal - p) / step).transpose();
    }
    result.mesh = relaxed(result.mesh, seam_edges, onto_target, step > 1 ? rounds_per_step : settling_rounds);
  }
  require_room(result.mesh, target, plan);
  return result;
}

}  // namespace softform
