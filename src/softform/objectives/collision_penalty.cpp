#include "softform/objectives/collision_penalty.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <queue>
#include <unordered_map>
#include <utility>

#include <nanoflann.hpp>

#include "softform/mesh/triangle_mesh.hpp"

namespace softform {
namespace {

// What nanoflann wants to know of a point cloud.
struct PointCloud {
  const double* data;
  std::size_t count;
  std::size_t kdtree_get_point_count() const { return count; }
  double kdtree_get_pt(std::size_t i, std::size_t axis) const { return data[3 * i + axis]; }
  template <class Box>
  bool kdtree_get_bbox(Box&) const
  {
    return false;
  }
};

using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, PointCloud>, PointCloud, 3>;

// Vertices within `radius` of `source` along the edges (Dijkstra), sorted.
std::vector<int> within_edge_distance(const std::vector<std::vector<int>>& neighbours, ConstVec x, int source,
                                      double radius)
{
  using Candidate = std::pair<double, int>;
  std::priority_queue<Candidate, std::vector<Candidate>, std::greater<>> queue;
  std::unordered_map<int, double> distance{{source, 0}};
  queue.emplace(0, source);
  std::vector<int> reached;
  while (!queue.empty()) {
    const auto [d, i] = queue.top();
    queue.pop();
    if (d > distance[i]) continue;
    reached.push_back(i);
    for (int j : neighbours[static_cast<std::size_t>(i)]) {
      const double through_i = d + (vertex(x, i) - vertex(x, j)).norm();
      if (through_i > radius) continue;
      const auto [entry, is_new] = distance.try_emplace(j, through_i);
      if (!is_new && entry->second <= through_i) continue;
      entry->second = through_i;
      queue.emplace(through_i, j);
    }
  }
  std::sort(reached.begin(), reached.end());
  return reached;
}

}  // namespace

CollisionPenalty::CollisionPenalty(const Triangles& triangles, ConstVec rest_positions, double threshold,
                                   double geodesic)
    : threshold_(threshold)
{
  const int vertex_count = static_cast<int>(rest_positions.size() / 3);
  const auto neighbours = vertex_neighbours(triangles, vertex_count);
  near_on_surface_.reserve(static_cast<std::size_t>(vertex_count));
  for (int i = 0; i < vertex_count; ++i)
    near_on_surface_.push_back(within_edge_distance(neighbours, rest_positions, i, geodesic));
}

std::vector<CollisionPenalty::Pair> CollisionPenalty::close_pairs(ConstVec x) const
{
  const PointCloud cloud{x.data(), static_cast<std::size_t>(x.size() / 3)};
  const Tree tree(3, cloud);
  std::vector<Pair> pairs;
  std::vector<std::pair<unsigned, double>> matches;
  for (std::size_t i = 0; i < cloud.count; ++i) {
    matches.clear();
    tree.radiusSearch(x.data() + 3 * i, threshold_ * threshold_, matches, nanoflann::SearchParams());
    const auto& near = near_on_surface_[i];
    for (const auto& [j, squared_distance] : matches)
      if (j > i && squared_distance > 0 && !std::binary_search(near.begin(), near.end(), static_cast<int>(j)))
        pairs.push_back({static_cast<int>(i), static_cast<int>(j)});
  }
  std::sort(pairs.begin(), pairs.end(),
            [](const Pair& a, const Pair& b) { return std::tie(a.i, a.j) < std::tie(b.i, b.j); });
  return pairs;
}

double CollisionPenalty::value(ConstVec x) const
{
  double sum = 0;
  for (const auto& [i, j] : close_pairs(x)) {
    const double gap = 1 - (vertex(x, i) - vertex(x, j)).norm() / threshold_;
    sum += gap * gap * gap;
  }
  return sum / static_cast<double>(near_on_surface_.size());
}

void CollisionPenalty::gradient(ConstVec x, Vec& g) const
{
  g.setZero(x.size());
  const double scale = 3 / (threshold_ * static_cast<double>(near_on_surface_.size()));
  for (const auto& [i, j] : close_pairs(x)) {
    const Vec3 d = vertex(x, i) - vertex(x, j);
    const double gap = 1 - d.norm() / threshold_;
    const Vec3 push = scale * gap * gap * d.normalized();
    g.segment<3>(3 * i) -= push;
    g.segment<3>(3 * j) += push;
  }
}

void CollisionPenalty::gauss_newton_hessian(ConstVec x, SparseMatrix& H) const
{
  const int vertex_count = static_cast<int>(near_on_surface_.size());
  if (H.rows() != x.size() || H.nonZeros() != 3 * x.size()) {
    H.resize(x.size(), x.size());
    H.reserve(Eigen::VectorXi::Constant(x.size(), 3));
    for (int i = 0; i < vertex_count; ++i)
      for (int q = 0; q < 3; ++q)
        for (int p = 0; p < 3; ++p) H.insert(3 * i + p, 3 * i + q) = 0;
    H.makeCompressed();
  }
  H.coeffs().setZero();
  const double scale = 6 / (threshold_ * threshold_ * static_cast<double>(vertex_count));
  for (const auto& [i, j] : close_pairs(x)) {
    const Vec3 d = vertex(x, i) - vertex(x, j);
    const Vec3 n = d.normalized();
    // (a - b)(a - b)^t <= 2 (a a^t + b b^t)
    const Eigen::Matrix3d block = 2 * scale * (1 - d.norm() / threshold_) * n * n.transpose();
    for (int k : {i, j}) Eigen::Map<Eigen::Matrix3d>(H.valuePtr() + 9 * k) += block;
  }
}

}  // namespace softform
