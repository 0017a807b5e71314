#include "softform/mesh/triangle_mesh.hpp"

#include <algorithm>
#include <cstdint>
#include <unordered_map>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "softform/core/error.hpp"

namespace softform {
namespace {

std::uint64_t edge_key(int a, int b)
{
  const auto [low, high] = std::minmax(a, b);
  return (static_cast<std::uint64_t>(low) << 32) | static_cast<std::uint32_t>(high);
}

Vec3 area_vector(ConstVec x, const Triangles& triangles, int t)
{
  const Vec3 a = vertex(x, triangles(t, 0));
  const Vec3 b = vertex(x, triangles(t, 1));
  const Vec3 c = vertex(x, triangles(t, 2));
  return 0.5 * (b - a).cross(c - a);
}

}  // namespace

std::vector<Edge> edges_of(const Triangles& triangles, int vertex_count)
{
  std::vector<Edge> edges;
  edges.reserve(static_cast<std::size_t>(triangles.rows()) * 3 / 2);
  std::unordered_map<std::uint64_t, std::size_t> known;
  known.reserve(static_cast<std::size_t>(vertex_count) * 3);
  for (int t = 0; t < triangles.rows(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const int start = triangles(t, k);
      const int end = triangles(t, (k + 1) % 3);
      const int opposite = triangles(t, (k + 2) % 3);
      const auto [entry, is_new] = known.try_emplace(edge_key(start, end), edges.size());
      if (is_new) {
        edges.push_back({start, end, opposite, -1});
        continue;
      }
      Edge& edge = edges[entry->second];
      if (edge.right >= 0)
        throw InputError(fmt::format("edge {}-{} has more than two triangles (one is triangle {})", start, end, t));
      if (edge.start == start)
        throw InputError(
            fmt::format("triangle {} and its neighbour across edge {}-{} face opposite sides", t, start, end));
      edge.right = opposite;
    }
  }
  return edges;
}

std::vector<std::vector<int>> vertex_neighbours(const Triangles& triangles, int vertex_count)
{
  std::vector<std::vector<int>> neighbours(static_cast<std::size_t>(vertex_count));
  for (int t = 0; t < triangles.rows(); ++t) {
    for (int k = 0; k < 3; ++k) {
      auto& list = neighbours[static_cast<std::size_t>(triangles(t, k))];
      list.push_back(triangles(t, (k + 1) % 3));
      list.push_back(triangles(t, (k + 2) % 3));
    }
  }
  for (auto& list : neighbours) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
  return neighbours;
}

double enclosed_volume(ConstVec x, const Triangles& triangles)
{
  double volume = 0;
  for (int t = 0; t < triangles.rows(); ++t) {
    const Vec3 a = vertex(x, triangles(t, 0));
    const Vec3 b = vertex(x, triangles(t, 1));
    const Vec3 c = vertex(x, triangles(t, 2));
    volume += a.dot(b.cross(c)) / 6;
  }
  return volume;
}

double enclosed_volume(const TriangleMesh& mesh) { return enclosed_volume(flatten(mesh.vertices), mesh.triangles); }

double surface_area(ConstVec x, const Triangles& triangles)
{
  double area = 0;
  for (int t = 0; t < triangles.rows(); ++t) area += area_vector(x, triangles, t).norm();
  return area;
}

Vec vertex_areas(ConstVec x, const Triangles& triangles)
{
  Vec areas = Vec::Zero(x.size() / 3);
  for (int t = 0; t < triangles.rows(); ++t) {
    const double third = area_vector(x, triangles, t).norm() / 3;
    for (int k = 0; k < 3; ++k) areas[triangles(t, k)] += third;
  }
  return areas;
}

double mean_edge_length(const TriangleMesh& mesh)
{
  double sum = 0;
  const auto edges = edges_of(mesh.triangles, mesh.vertex_count());
  for (const Edge& edge : edges) sum += (mesh.vertices.row(edge.start) - mesh.vertices.row(edge.end)).norm();
  return edges.empty() ? 0 : sum / static_cast<double>(edges.size());
}

double diameter(const Positions& vertices)
{
  double largest = 0;
  for (Eigen::Index i = 0; i < vertices.rows(); ++i)
    largest = std::max(largest, (vertices.rowwise() - vertices.row(i)).rowwise().squaredNorm().maxCoeff());
  return std::sqrt(largest);
}

TriangleMesh scale_to_diameter(TriangleMesh mesh, double wanted)
{
  mesh.vertices *= wanted / diameter(mesh.vertices);
  return mesh;
}

Positions vertex_normals(ConstVec x, const Triangles& triangles)
{
  Positions normals = Positions::Zero(x.size() / 3, 3);
  for (int t = 0; t < triangles.rows(); ++t) {
    const Vec3 n = area_vector(x, triangles, t);
    for (int k = 0; k < 3; ++k) normals.row(triangles(t, k)) += n.transpose();
  }
  normals.rowwise().normalize();
  return normals;
}

}  // namespace softform
