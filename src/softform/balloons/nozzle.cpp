#include "softform/balloons/nozzle.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "softform/core/error.hpp"

namespace softform {
namespace {

void validate(const TriangleMesh& target, const NozzlePlacement& placement)
{
  if (!(placement.diameter > 0) || !std::isfinite(placement.diameter))
    throw InputError(fmt::format("the nozzle's diameter is {} m: it must be positive", placement.diameter));
  if (placement.vertex && (*placement.vertex < 0 || *placement.vertex >= target.vertex_count()))
    throw InputError(fmt::format("the nozzle's vertex is {}: the target's are numbered 0 to {}", *placement.vertex,
                                 target.vertex_count() - 1));
  if (!placement.vertex && !(placement.direction.allFinite() && placement.direction.norm() > 0))
    throw InputError("the nozzle's direction has no length: give one such as 0,0,-1");
}

// Far along the direction, but at least twice as far as off the axis: the middle of a flat underside, not its edge.
int vertex_towards(const TriangleMesh& target, const Vec3& direction)
{
  constexpr double off_axis = 2;
  const Vec areas = vertex_areas(flatten(target.vertices), target.triangles);
  const Eigen::RowVector3d centroid = areas.transpose() * target.vertices / areas.sum();
  const Positions offsets = target.vertices.rowwise() - centroid;
  const Vec along = offsets * direction.normalized();
  const Vec across = (offsets.rowwise().squaredNorm() - along.cwiseAbs2()).cwiseMax(0).cwiseSqrt();
  Eigen::Index best;
  (along - off_axis * across).maxCoeff(&best);
  return static_cast<int>(best);
}

// What a set of vertices spans: its triangles' number and area vector, and whether they are one disc.
struct Patch {
  int triangles = 0;
  Vec3 area = Vec3::Zero();
  bool is_disc = false;
};

Patch patch_of(const TriangleMesh& mesh, const std::vector<char>& is_inside)
{
  const auto inside = [&](int i) { return is_inside[static_cast<std::size_t>(i)] != 0; };
  Patch patch;
  std::vector<char> is_used(is_inside.size(), 0);
  for (const auto& triangle : mesh.triangles.rowwise()) {
    if (!inside(triangle[0]) || !inside(triangle[1]) || !inside(triangle[2])) continue;
    const Vec3 a = mesh.vertices.row(triangle[0]), b = mesh.vertices.row(triangle[1]),
               c = mesh.vertices.row(triangle[2]);
    patch.area += 0.5 * (b - a).cross(c - a);
    ++patch.triangles;
    for (const int i : triangle) is_used[static_cast<std::size_t>(i)] = 1;
  }
  int edges = 0;
  for (const Edge& edge : edges_of(mesh.triangles, mesh.vertex_count())) {
    const bool has_triangle = inside(edge.left) || (edge.right >= 0 && inside(edge.right));
    if (inside(edge.start) && inside(edge.end) && has_triangle) ++edges;
  }
  const auto used = std::count(is_used.begin(), is_used.end(), 1);
  patch.is_disc = used - edges + patch.triangles == 1;  // Euler's characteristic
  return patch;
}

}  // namespace

std::vector<int> vertices_around(const TriangleMesh& mesh, int vertex, double distance)
{
  const auto neighbours = vertex_neighbours(mesh.triangles, mesh.vertex_count());
  std::vector<char> is_seen(neighbours.size(), 0);
  std::vector<int> found{vertex};
  is_seen[static_cast<std::size_t>(vertex)] = 1;
  for (std::size_t k = 0; k < found.size(); ++k) {
    for (const int j : neighbours[static_cast<std::size_t>(found[k])]) {
      char& seen = is_seen[static_cast<std::size_t>(j)];
      if (seen != 0 || (mesh.vertices.row(j) - mesh.vertices.row(vertex)).norm() > distance) continue;
      seen = 1;
      found.push_back(j);
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

Nozzle place_nozzle(const TriangleMesh& target, const NozzlePlacement& placement)
{
  validate(target, placement);
  Nozzle nozzle;
  nozzle.centre = placement.vertex ? *placement.vertex : vertex_towards(target, placement.direction);
  nozzle.position = target.vertices.row(nozzle.centre);
  nozzle.radius = placement.diameter / 2;
  nozzle.vertices = vertices_around(target, nozzle.centre, nozzle.radius);

  const auto neighbours = vertex_neighbours(target.triangles, target.vertex_count());
  double ring = 0;
  for (const int j : neighbours[static_cast<std::size_t>(nozzle.centre)])
    ring = std::max(ring, (target.vertices.row(j).transpose() - nozzle.position).norm());
  const auto in_mm = [](double metres) { return 1e3 * metres; };
  if (ring > nozzle.radius)
    throw InputError(
        fmt::format("a nozzle of {:.3g} mm is finer than the mesh at vertex {}: ask for at least {:.3g} mm, "
                    "or give a finer mesh",
                    in_mm(placement.diameter), nozzle.centre, std::ceil(20 * in_mm(ring)) / 10));
  std::vector<char> is_inside(neighbours.size(), 0);
  for (const int i : nozzle.vertices) is_inside[static_cast<std::size_t>(i)] = 1;
  const Patch patch = patch_of(target, is_inside);
  if (!patch.is_disc || patch.area.norm() == 0)
    throw InputError(
        fmt::format("the surface within {:.3g} mm of vertex {} is no disc, so that no nozzle fits there: "
                    "ask for a smaller one, or another place",
                    in_mm(nozzle.radius), nozzle.centre));
  nozzle.axis = patch.area.normalized();
  return nozzle;
}

FixedDofs held_by(const Nozzle& nozzle, int vertex_count)
{
  FixedDofs fixed{Vec::Ones(3 * vertex_count)};
  for (const int i : nozzle.vertices) fixed.free.segment<3>(3 * i).setZero();
  return fixed;
}

}  // namespace softform
