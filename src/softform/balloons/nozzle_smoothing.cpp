#include "softform/balloons/nozzle_smoothing.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "softform/core/error.hpp"
#include "softform/mesh/self_intersections.hpp"
#include "softform/optimizers/gradient_projection.hpp"

namespace softform {
namespace {

Vec3 normal_of(const TriangleMesh& mesh, int t)
{
  const auto corner = [&](int k) -> Vec3 { return mesh.vertices.row(mesh.triangles(t, k)); };
  return (corner(1) - corner(0)).cross(corner(2) - corner(0));
}

// Through the vertices within `distance` of the nozzle, with a margin: a detail of the shape, finely resolved.
RbfImplicit implicit_around(const TriangleMesh& shape, const Nozzle& nozzle, double distance)
{
  constexpr double margin = 1.3;
  constexpr int most_centres = 1200;
  const std::vector<int> patch = vertices_around(shape, nozzle.centre, margin * distance);
  const Positions normals = vertex_normals(flatten(shape.vertices), shape.triangles);
  RbfOptions options;
  options.centres = most_centres;
  options.offset = 0.5 * mean_edge_length(shape);
  options.smoothing = 0;
  return RbfImplicit::from_normals(shape.vertices(patch, Eigen::all), normals(patch, Eigen::all), options);
}

TriangleMesh smoothed(const TriangleMesh& mesh, const std::vector<int>& free, const RbfImplicit& surface,
                      double surface_weight)
{
  const NozzleSmoothing program(mesh, free, surface, surface_weight);
  ProjectedNewtonOptions newton;
  newton.hessian = HessianModel::GaussNewton;
  StopCriteria stop;
  stop.tolerance = 1e-6;
  stop.relative_decrease = 1e-6;
  return program.mesh_at(GradientProjection(newton).minimize(program, stop).z);
}

// Triangles with a free vertex that face the other way than the surface.
bool has_flipped_triangle(const TriangleMesh& mesh, const std::vector<int>& free, const RbfImplicit& surface)
{
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    const auto corners = mesh.triangles.row(t);
    const auto moves = [&](int i) { return std::binary_search(free.begin(), free.end(), i); };
    if (!moves(corners[0]) && !moves(corners[1]) && !moves(corners[2])) continue;
    const Eigen::RowVector3d middle = mesh.vertices(corners, Eigen::all).colwise().mean();
    Vec3 outwards;
    surface.value(middle.transpose(), outwards);
    if (!(normal_of(mesh, t).dot(outwards) > 0)) return true;
  }
  return false;
}

// How far the nozzle's vertices are from a surface [m].
double misfit(const TriangleMesh& target, const Nozzle& nozzle, const RbfImplicit& surface)
{
  double largest = 0;
  for (const int i : nozzle.vertices)
    largest = std::max(largest, std::abs(surface.value(target.vertices.row(i).transpose())));
  return largest;
}

[[noreturn]] void refuse(const Nozzle& nozzle, double scale)
{
  throw InputError(
      fmt::format("a nozzle of {:.3g} mm does not fit on the rest shape, which is the target scaled by "
                  "{:.3g}: ask for a smaller nozzle, a larger scale or another place",
                  2e3 * nozzle.radius, scale));
}

}  // namespace

NozzleSmoothing::NozzleSmoothing(TriangleMesh mesh, std::vector<int> free, const RbfImplicit& surface,
                                 double surface_weight)
    : mesh_(std::move(mesh)),
      free_(std::move(free)),
      variable_of_(static_cast<std::size_t>(mesh_.vertex_count()), -1),
      surface_(surface),
      unit_(mean_edge_length(mesh_)),
      root_weight_(std::sqrt(surface_weight))
{
  const auto is_free = [this](int i) { return variable_of_[static_cast<std::size_t>(i)] >= 0; };
  for (std::size_t k = 0; k < free_.size(); ++k) variable_of_[static_cast<std::size_t>(free_[k])] = static_cast<int>(k);
  auto neighbours = vertex_neighbours(mesh_.triangles, mesh_.vertex_count());
  for (int i = 0; i < mesh_.vertex_count(); ++i) {
    auto& ring = neighbours[static_cast<std::size_t>(i)];
    if (is_free(i) || std::any_of(ring.begin(), ring.end(), is_free)) rings_.push_back({i, std::move(ring)});
  }
}

Vec NozzleSmoothing::initial_point() const
{
  const Positions positions = mesh_.vertices(free_, Eigen::all);
  return flatten(positions) / unit_;
}

TriangleMesh NozzleSmoothing::mesh_at(ConstVec z) const
{
  TriangleMesh mesh = mesh_;
  mesh.vertices(free_, Eigen::all) = unit_ * unflatten(z);
  return mesh;
}

void NozzleSmoothing::residuals(ConstVec z, Vec& r) const
{
  const Positions X = mesh_at(z).vertices;
  r.resize(residual_count());
  Eigen::Index row = 0;
  for (const Ring& ring : rings_) {
    const Eigen::RowVector3d offset = X.row(ring.vertex) - X(ring.neighbours, Eigen::all).colwise().mean();
    r.segment<3>(row) = offset.transpose() / unit_;
    row += 3;
  }
  for (const int i : free_) r[row++] = root_weight_ * surface_.value(X.row(i).transpose()) / unit_;
}

void NozzleSmoothing::residual_jacobian(ConstVec z, SparseMatrix& R) const
{
  std::vector<Eigen::Triplet<double>> entries;
  const auto add = [&](int row, int vertex, double value) {
    const int k = variable_of_[static_cast<std::size_t>(vertex)];
    for (int d = 0; k >= 0 && d < 3; ++d) entries.emplace_back(row + d, 3 * k + d, value);
  };
  int row = 0;
  for (const Ring& ring : rings_) {
    add(row, ring.vertex, 1);
    for (const int j : ring.neighbours) add(row, j, -1.0 / static_cast<double>(ring.neighbours.size()));
    row += 3;
  }
  Vec3 gradient;
  for (int k = 0; k < static_cast<int>(free_.size()); ++k, ++row) {
    surface_.value(unit_ * z.segment<3>(3 * k), gradient);
    for (int d = 0; d < 3; ++d) entries.emplace_back(row, 3 * k + d, root_weight_ * gradient[d]);
  }
  R.resize(residual_count(), variable_count());
  R.setFromTriplets(entries.begin(), entries.end());
}

TriangleMesh rest_shape_with_nozzle(const TriangleMesh& target, const Nozzle& nozzle, double scale,
                                    const NozzleSmoothingOptions& options)
{
  const Eigen::RowVector3d centre = nozzle.position.transpose();
  TriangleMesh shape = target;
  shape.vertices = (scale * (target.vertices.rowwise() - centre)).rowwise() + centre;
  const RbfImplicit surface = implicit_around(shape, nozzle, options.reach * nozzle.radius);
  // Where the scaled surface curves away from under the nozzle, a tube of that width has no place on it.
  if (misfit(target, nozzle, surface) > nozzle.radius / 2) refuse(nozzle, scale);
  const std::vector<int> region = vertices_around(shape, nozzle.centre, options.reach * nozzle.radius);
  std::vector<int> free;
  std::set_difference(region.begin(), region.end(), nozzle.vertices.begin(), nozzle.vertices.end(),
                      std::back_inserter(free));

  const Positions scaled = shape.vertices;
  for (int k = 1; k <= options.steps; ++k) {
    for (const int i : nozzle.vertices)
      shape.vertices.row(i) = scaled.row(i) + k * (target.vertices.row(i) - scaled.row(i)) / options.steps;
    shape = smoothed(shape, free, surface, options.surface_weight);
  }
  for (const int i : nozzle.vertices) shape.vertices.row(i) = target.vertices.row(i);  // to the last bit
  if (has_flipped_triangle(shape, free, surface) || count_self_intersections(shape) > 0) refuse(nozzle, scale);
  return shape;
}

}  // namespace softform
