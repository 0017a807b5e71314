#include "softform/mesh/geodesic.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

namespace softform {
namespace {

/// Lengths of the points' moves under which a path counts as tight, relative to their spacing.
constexpr double tightness = 1e-4;
constexpr int largest_sweeps = 200;

Vec3 corner(const TriangleMesh& mesh, int triangle, int k) { return mesh.vertices.row(mesh.triangles(triangle, k)); }

}  // namespace

Vec arc_lengths(const Positions& polyline)
{
  Vec arcs = Vec::Zero(polyline.rows());
  for (Eigen::Index i = 1; i < polyline.rows(); ++i)
    arcs[i] = arcs[i - 1] + (polyline.row(i) - polyline.row(i - 1)).norm();
  return arcs;
}

Vec3 point_at(const Positions& polyline, const Vec& arcs, double arc)
{
  const double* above = std::upper_bound(arcs.data(), arcs.data() + arcs.size(), arc);
  const Eigen::Index i = std::clamp<Eigen::Index>(above - arcs.data(), 1, arcs.size() - 1);
  const double length = arcs[i] - arcs[i - 1];
  const double t = length > 0 ? std::clamp((arc - arcs[i - 1]) / length, 0.0, 1.0) : 0.0;
  return (1 - t) * polyline.row(i - 1) + t * polyline.row(i);
}

Positions resampled(const Positions& polyline, int count)
{
  const Vec arcs = arc_lengths(polyline);
  Positions result(count, 3);
  for (int i = 0; i < count; ++i)
    result.row(i) = point_at(polyline, arcs, arcs[arcs.size() - 1] * i / (count - 1)).transpose();
  result.row(0) = polyline.row(0);
  result.row(count - 1) = polyline.row(polyline.rows() - 1);
  return result;
}

Geodesics::Geodesics(const TriangleMesh& mesh)
    : mesh_(mesh), neighbours_(vertex_neighbours(mesh.triangles, mesh.vertex_count())), surface_(mesh)
{}

/// Dijkstra from the corners of the start's triangle to those of the end's.
Positions Geodesics::edge_path(const ClosestPoint& start, const ClosestPoint& end) const
{
  const auto count = static_cast<std::size_t>(mesh_.vertex_count());
  std::vector<double> distance(count, std::numeric_limits<double>::infinity());
  std::vector<int> previous(count, -1);
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  const auto reach = [&](int v, double d, int from) {
    if (d >= distance[static_cast<std::size_t>(v)]) return;
    distance[static_cast<std::size_t>(v)] = d;
    previous[static_cast<std::size_t>(v)] = from;
    queue.emplace(d, v);
  };
  for (int k = 0; k < 3; ++k)
    reach(mesh_.triangles(start.triangle, k), (corner(mesh_, start.triangle, k) - start.position).norm(), -1);
  while (!queue.empty()) {
    const auto [d, v] = queue.top();
    queue.pop();
    if (d > distance[static_cast<std::size_t>(v)]) continue;
    for (const int w : neighbours_[static_cast<std::size_t>(v)])
      reach(w, d + (mesh_.vertices.row(w) - mesh_.vertices.row(v)).norm(), v);
  }

  int last = -1;
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k) {
    const int v = mesh_.triangles(end.triangle, k);
    const double d = distance[static_cast<std::size_t>(v)] + (corner(mesh_, end.triangle, k) - end.position).norm();
    if (d < least) least = d, last = v;
  }
  std::vector<int> vertices;
  for (int v = last; v >= 0; v = previous[static_cast<std::size_t>(v)]) vertices.push_back(v);
  Positions path(static_cast<Eigen::Index>(vertices.size()) + 2, 3);
  path.row(0) = start.position.transpose();
  for (std::size_t i = 0; i < vertices.size(); ++i)
    path.row(static_cast<Eigen::Index>(vertices.size() - i)) = mesh_.vertices.row(vertices[i]);
  path.row(path.rows() - 1) = end.position.transpose();
  return path;
}

/// Every point goes to the surface below the middle of its neighbours, over-relaxed.
void Geodesics::pull_tight(Positions& path) const
{
  const Eigen::Index n = path.rows();
  const double spacing = arc_lengths(path)[n - 1] / static_cast<double>(n - 1);
  // The best factor for the Laplacian of a chain (Young 1954), a little short of it for the curvature's sake.
  const double factor = std::min(1.9, 2 / (1 + std::sin(std::acos(-1.0) / static_cast<double>(n - 1))));
  for (int sweep = 0; sweep < largest_sweeps; ++sweep) {
    double largest_move = 0;
    for (Eigen::Index i = 1; i + 1 < n; ++i) {
      const Vec3 old = path.row(i);
      const Vec3 middle = 0.5 * (path.row(i - 1) + path.row(i + 1));
      const Vec3 moved = surface_.closest(old + factor * (middle - old)).position;
      largest_move = std::max(largest_move, (moved - old).norm());
      path.row(i) = moved.transpose();
    }
    if (largest_move < tightness * spacing) break;
  }
}

Positions Geodesics::path(const Vec3& start, const Vec3& end, double spacing) const
{
  const ClosestPoint from = surface_.closest(start), to = surface_.closest(end);
  Positions path = edge_path(from, to);
  const double length = arc_lengths(path)[path.rows() - 1];
  if (!(length > 0)) return path.topRows(2);
  // Long waves die out fast where points are few: coarse first.
  const int pieces = std::max(2, static_cast<int>(std::ceil(length / spacing)));
  for (int coarsening = 8; coarsening >= 1; coarsening /= 2) {
    path = resampled(path, 1 + std::max(2, pieces / coarsening));
    pull_tight(path);
  }
  return path;
}

}  // namespace softform
