#include "softform/characters/boundary_normals.hpp"

namespace softform {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

// v/|v| and its derivative by v.
std::pair<Vector2d, Matrix2d> unit(const Vector2d& v)
{
  const Vector2d u = v.normalized();
  return {u, (Matrix2d::Identity() - u * u.transpose()) / v.norm()};
}

// The right-hand unit normal of an edge and its derivative by the edge.
std::pair<Vector2d, Matrix2d> edge_normal(const Vector2d& edge)
{
  const Matrix2d turn = (Matrix2d() << 0, 1, -1, 0).finished();
  const auto [direction, derivative] = unit(edge);
  return {turn * direction, turn * derivative};
}

}  // namespace

BoundaryNormals::BoundaryNormals(const PlanarSolid& body)
    : previous_(static_cast<std::size_t>(body.vertex_count()), -1), next_(previous_)
{
  const auto edges = boundary_faces<2>(body.elements()).faces;
  for (const auto& edge : edges.rowwise()) {
    next_[static_cast<std::size_t>(edge[0])] = edge[1];
    previous_[static_cast<std::size_t>(edge[1])] = edge[0];
  }
}

InterpolatedNormal BoundaryNormals::interpolated(const std::vector<BoundaryWeight>& weights, ConstVec x) const
{
  struct VertexNormal {
    int previous, vertex, next;
    Matrix2d by_first, by_second;  // of the vertex normal, by its edges
  };
  std::vector<VertexNormal> vertices;
  Vector2d sum = Vector2d::Zero();
  Matrix2d sum_by_place = Matrix2d::Zero();
  for (const BoundaryWeight& w : weights) {
    const int before = previous_[static_cast<std::size_t>(w.vertex)], after = next_[static_cast<std::size_t>(w.vertex)];
    const auto at = [&](int vertex) -> Vector2d { return x.segment<2>(2 * vertex); };
    const auto [first, first_slope] = edge_normal(at(w.vertex) - at(before));
    const auto [second, second_slope] = edge_normal(at(after) - at(w.vertex));
    const auto [normal, slope] = unit(first + second);
    vertices.push_back({before, w.vertex, after, slope * first_slope, slope * second_slope});
    sum += w.value * normal;
    sum_by_place += normal * w.gradient.transpose();
  }
  const auto [normal, slope] = unit(sum);
  InterpolatedNormal result{normal, {}, slope * sum_by_place};
  for (std::size_t k = 0; k < weights.size(); ++k) {
    const VertexNormal& v = vertices[k];
    const Matrix2d scale = weights[k].value * slope;
    result.by_positions.emplace_back(v.previous, -scale * v.by_first);
    result.by_positions.emplace_back(v.vertex, scale * (v.by_first - v.by_second));
    result.by_positions.emplace_back(v.next, scale * v.by_second);
  }
  return result;
}

}  // namespace softform
