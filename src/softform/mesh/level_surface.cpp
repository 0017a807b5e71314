#include "softform/mesh/level_surface.hpp"

#include <algorithm>
#include <cstdint>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "softform/core/error.hpp"

namespace softform {
namespace {

/// A node of the grid, relative to the point inside; also the cube that has it as its lowest corner.
using Node = Eigen::Vector3i;
using Edge = std::pair<Node, Node>;  ///< from inside to outside

constexpr int largest_index = 1000;

std::int64_t key(const Node& n)
{
  const auto part = [](int i) { return std::int64_t(i) + 2 * largest_index; };
  return (part(n.x()) << 40) | (part(n.y()) << 20) | part(n.z());
}

/// A cube's corner number k has the bits of k as coordinates. The six tetrahedra around the diagonal 0-7 meet those of
/// the neighbouring cubes face to face.
Node corner(const Node& cube, int k) { return cube + Node(k & 1, k >> 1 & 1, k >> 2 & 1); }
constexpr int tetrahedra[6][4] = {{0, 1, 3, 7}, {0, 1, 5, 7}, {0, 2, 3, 7}, {0, 2, 6, 7}, {0, 4, 5, 7}, {0, 4, 6, 7}};

class Tracer {
 public:
  Tracer(const std::function<double(const Vec3&)>& f, const Vec3& inside, double step)
      : f_(f), origin_(inside), step_(step)
  {}

  TriangleMesh trace()
  {
    visit(first_cube());
    for (std::size_t k = 0; k < cubes_.size(); ++k) {
      const Node cube = cubes_[k];
      if (cube.cwiseAbs().maxCoeff() >= largest_index)
        throw InputError("the surface does not end within 1000 steps of the grid; use a larger step");
      for (const auto& tetrahedron : tetrahedra) cut(cube, tetrahedron);
      for (int axis = 0; axis < 3; ++axis)
        for (const int side : {0, 1})
          if (crosses_face(cube, axis, side)) visit(cube + (2 * side - 1) * Node(Node::Unit(axis)));
    }
    TriangleMesh mesh{Positions(Eigen::Index(vertices_.size()), 3), Triangles(Eigen::Index(triangles_.size()), 3)};
    for (std::size_t i = 0; i < vertices_.size(); ++i) mesh.vertices.row(Eigen::Index(i)) = vertices_[i];
    for (std::size_t t = 0; t < triangles_.size(); ++t) mesh.triangles.row(Eigen::Index(t)) = triangles_[t];
    return mesh;
  }

 private:
  Vec3 position(const Node& node) const { return origin_ + step_ * node.cast<double>(); }

  double value(const Node& node)
  {
    const auto [entry, is_new] = values_.try_emplace(key(node), 0.0);
    if (is_new) entry->second = f_(position(node));
    return entry->second;
  }
  bool is_inside(const Node& node) { return value(node) < 0; }

  /// Along the x axis from the point inside.
  Node first_cube()
  {
    Node node = Node::Zero();
    if (!is_inside(node)) throw InputError("the point to start from is not inside the surface; choose another");
    while (is_inside(node)) {
      ++node.x();
      if (node.x() >= largest_index)
        throw InputError("the surface does not end within 1000 steps of the grid; use a larger step");
    }
    return node - Node::UnitX();
  }

  void visit(const Node& cube)
  {
    if (seen_.insert(key(cube)).second) cubes_.push_back(cube);
  }

  bool crosses_face(const Node& cube, int axis, int side)
  {
    int inside = 0;
    for (int k = 0; k < 8; ++k)
      if ((k >> axis & 1) == side && is_inside(corner(cube, k))) ++inside;
    return inside > 0 && inside < 4;
  }

  void cut(const Node& cube, const int (&tetrahedron)[4])
  {
    std::vector<Node> in, out;
    for (const int k : tetrahedron) {
      const Node node = corner(cube, k);
      (is_inside(node) ? in : out).push_back(node);
    }
    if (in.size() == 1) add_triangle({in[0], out[0]}, {in[0], out[1]}, {in[0], out[2]});
    if (in.size() == 3) add_triangle({in[0], out[0]}, {in[1], out[0]}, {in[2], out[0]});
    if (in.size() == 2) {
      add_triangle({in[0], out[0]}, {in[0], out[1]}, {in[1], out[1]});
      add_triangle({in[0], out[0]}, {in[1], out[1]}, {in[1], out[0]});
    }
  }

  /// Oriented by the edges' midpoints, in integers: from inside to outside whatever the values are.
  void add_triangle(const Edge& a, const Edge& b, const Edge& c)
  {
    const auto middle = [](const Edge& edge) -> Node { return edge.first + edge.second; };
    const Node normal = (middle(b) - middle(a)).cross(middle(c) - middle(a));
    Eigen::RowVector3i triangle(vertex(a), vertex(b), vertex(c));
    if (normal.dot(a.second - a.first) < 0) std::swap(triangle[1], triangle[2]);
    triangles_.push_back(triangle);
  }

  int vertex(const Edge& edge)
  {
    auto& ends = on_edge_[key(edge.first)];
    const auto known =
        std::find_if(ends.begin(), ends.end(), [&](const auto& e) { return e.first == key(edge.second); });
    if (known != ends.end()) return known->second;
    const double in = value(edge.first), out = value(edge.second);
    // Off the nodes, where several vertices would coincide.
    const double t = std::clamp(in / (in - out), 0.05, 0.95);
    vertices_.emplace_back((1 - t) * position(edge.first) + t * position(edge.second));
    ends.emplace_back(key(edge.second), int(vertices_.size()) - 1);
    return ends.back().second;
  }

  const std::function<double(const Vec3&)>& f_;
  Vec3 origin_;
  double step_;
  std::vector<Node> cubes_;  ///< that the surface crosses, in the order of their discovery
  std::unordered_set<std::int64_t> seen_;
  std::unordered_map<std::int64_t, double> values_;
  std::unordered_map<std::int64_t, std::vector<std::pair<std::int64_t, int>>> on_edge_;
  std::vector<Vec3> vertices_;
  std::vector<Eigen::RowVector3i> triangles_;
};

}  // namespace

TriangleMesh level_surface(const std::function<double(const Vec3&)>& f, const Vec3& inside, double step)
{
  return Tracer(f, inside, step).trace();
}

}  // namespace softform
