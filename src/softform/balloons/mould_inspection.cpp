#include <algorithm>
#include <cmath>
#include <numeric>

#include <Eigen/Geometry>

#include "softform/balloons/mould.hpp"
#include "softform/core/error.hpp"
#include "softform/core/parallel.hpp"
#include "softform/mesh/distance.hpp"
#include "softform/mesh/ray_caster.hpp"
#include "softform/mesh/solids.hpp"

namespace softform {
namespace {

std::vector<Vec3> unit_vectors(const std::vector<Vec3>& directions)
{
  if (directions.empty()) throw InputError("there is no direction to pull in: give one such as 0,0,1");
  std::vector<Vec3> units;
  for (const Vec3& direction : directions) {
    if (!direction.allFinite() || !(direction.norm() > 0))
      throw InputError("a direction to pull in has no length: give one such as 0,0,1");
    units.push_back(direction.normalized());
  }
  return units;
}

Vec triangle_areas(const TriangleMesh& mesh)
{
  Vec areas(mesh.triangle_count());
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    const auto corner = [&](int k) -> Vec3 { return mesh.vertices.row(mesh.triangles(t, k)); };
    areas[t] = 0.5 * (corner(1) - corner(0)).cross(corner(2) - corner(0)).norm();
  }
  return areas;
}

// Triangles by value, smallest first.
std::vector<int> sorted_by(const Vec& values)
{
  std::vector<int> order(static_cast<std::size_t>(values.size()));
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return values[a] < values[b]; });
  return order;
}

// The triangle whose value all but a ten-thousandth of the area exceeds: slivers where two parts meet say nothing.
int smallest(const Vec& values, const Vec& areas)
{
  double area = 0;
  for (const int t : sorted_by(values)) {
    area += areas[t];
    if (area > 1e-4 * areas.sum()) return t;
  }
  return 0;
}

bool is_trapped(const RayCaster& rays, int t, const std::vector<Vec3>& pulls)
{
  constexpr double parallel = -1e-6;  // walls along the pull slide
  return std::none_of(pulls.begin(), pulls.end(), [&](const Vec3& pull) {
    return rays.normal(t).dot(pull) >= parallel && !rays.from_triangle(t, pull);
  });
}

}  // namespace

std::vector<Vec3> pull_directions(const Nozzle& nozzle)
{
  const Eigen::Matrix3d frame = frame_along(nozzle.axis);
  return {-nozzle.axis, frame.col(0), -frame.col(0), frame.col(1), -frame.col(1)};
}

MouldInspection inspect_mould(const TriangleMesh& mould, const TriangleMesh& rest, const std::vector<Vec3>& pulls,
                              double smallest_feature)
{
  if (!(smallest_feature > 0)) throw InputError("the printer's smallest feature must be positive");
  const std::vector<Vec3> directions = unit_vectors(pulls);
  const double size = diameter(mould.vertices);
  const RayCaster rays(mould);
  const SurfaceDistance to_rest(rest);
  const int n = mould.triangle_count();
  MouldInspection found;
  found.thickness.resize(n);
  found.gap.resize(n);
  found.trapped.assign(static_cast<std::size_t>(n), 0);
  std::vector<char> bears_rubber(static_cast<std::size_t>(n), 0);
  parallel_for(n, [&](int t) {
    const auto k = static_cast<std::size_t>(t);
    const Vec3 normal = rays.normal(t);
    found.thickness[t] = rays.from_triangle(t, -normal).value_or(size);
    found.gap[t] = rays.from_triangle(t, normal).value_or(size);
    bears_rubber[k] = to_rest.distance(rays.middle(t)) < 1e-6 * size;
    found.trapped[k] = bears_rubber[k] != 0 && is_trapped(rays, t, directions);
  });

  const Vec areas = triangle_areas(mould);
  const int thinnest = smallest(found.thickness, areas);
  found.thinnest = rays.middle(thinnest);
  found.smallest_thickness = found.thickness[thinnest];
  found.smallest_gap = found.gap[smallest(found.gap, areas)];
  double thin = 0, trapped = 0, rubber = 0;
  for (int t = 0; t < n; ++t) {
    const auto k = static_cast<std::size_t>(t);
    if (found.thickness[t] < smallest_feature) thin += areas[t];
    if (bears_rubber[k] != 0) rubber += areas[t];
    if (found.trapped[k] != 0) trapped += areas[t];
  }
  found.thin_fraction = thin / areas.sum();
  found.trapped_fraction = trapped / rubber;
  return found;
}

}  // namespace softform
