#include "softform/inflatables/flatten.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <fmt/format.h>

#include "softform/core/error.hpp"
#include "softform/inflatables/boundary_flattening.hpp"
#include "softform/inflatables/symmetric_dirichlet.hpp"
#include "softform/optimizers/gradient_projection.hpp"

namespace softform {
namespace {

/// The edges of a triangle from its first vertex as columns, in its own plane.
Eigen::Matrix2d plane_edges(const TriangleMesh& mesh, int t)
{
  const Vec3 a = mesh.vertices.row(mesh.triangles(t, 0));
  const Vec3 u = mesh.vertices.row(mesh.triangles(t, 1)).transpose() - a;
  const Vec3 v = mesh.vertices.row(mesh.triangles(t, 2)).transpose() - a;
  Eigen::Matrix2d edges;
  edges << u.norm(), u.dot(v) / u.norm(), 0, u.cross(v).norm() / u.norm();
  return edges;
}

Eigen::Matrix2d flat_edges(const Triangles& triangles, const FlatPositions& flat, int t)
{
  Eigen::Matrix2d edges;
  for (int k = 0; k < 2; ++k) edges.col(k) = flat.row(triangles(t, k + 1)) - flat.row(triangles(t, 0));
  return edges;
}

void require_unfolded(const TriangleMesh& panel, const FlatPositions& flat, const std::string& name)
{
  int folded = 0;
  for (int t = 0; t < panel.triangle_count(); ++t) folded += !(flat_edges(panel.triangles, flat, t).determinant() > 0);
  if (folded > 0)
    throw InputError(
        fmt::format("panel '{}' folds over itself in {} triangles when it is flattened: flatten by "
                    "symmetric-dirichlet, or draw a seam through it",
                    name, folded));
}

/// Around the origin, the long axis along the first.
void align(FlatPositions& flat)
{
  flat.rowwise() -= flat.colwise().mean();
  const Eigen::Matrix2d moments = flat.transpose() * flat;
  const Eigen::Vector2d axis = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(moments).eigenvectors().col(1);
  Eigen::Matrix2d rotation;
  rotation << axis.x(), axis.y(), -axis.y(), axis.x();
  flat = (flat * rotation.transpose()).eval();
}

}  // namespace

FlatteningMethod flattening_method(const std::string& name)
{
  if (name == "boundary") return FlatteningMethod::Boundary;
  if (name == "symmetric-dirichlet") return FlatteningMethod::SymmetricDirichlet;
  throw InputError(fmt::format("there is no flattening '{}': use symmetric-dirichlet or boundary", name));
}

FlatPositions flattened(const TriangleMesh& given, const std::string& name, const FlatteningOptions& options)
{
  // At unit area, so that tolerances mean the same for every panel.
  const double unit = std::sqrt(surface_area(flatten(given.vertices), given.triangles));
  const TriangleMesh panel{given.vertices / unit, given.triangles};
  const std::vector<int> loop = boundary_loops(panel.triangles).front();
  FlatPositions flat;
  if (options.method == FlatteningMethod::Boundary) {
    flat = tutte_interior(panel, loop, flat_boundary(boundary_shape(panel, loop)));
  } else {
    ProjectedNewtonOptions newton;
    newton.hessian = HessianModel::GaussNewton;
    StopCriteria stop;
    stop.relative_decrease = 1e-9;
    const SymmetricDirichlet program(panel, loop, options.length_weight, tutte_disc(panel, loop));
    const Solution solution = GradientProjection(newton).minimize(program, stop);
    flat = Eigen::Map<const FlatPositions>(solution.z.data(), panel.vertex_count(), 2);
  }
  require_unfolded(panel, flat, name);
  align(flat);
  return unit * flat;
}

void flatten_panels(PanelLayout& layout, const FlatteningOptions& options)
{
  for (std::size_t i = 0; i < layout.panels.size(); ++i) {
    const Panel& panel = layout.panels[i];
    layout.flat.middleRows(panel.first_vertex, panel.vertex_count) =
        flattened(panel_mesh(layout, static_cast<int>(i)), panel.name, options);
  }
}

Distortion distortion(const PanelLayout& layout, int panel)
{
  const TriangleMesh mesh = panel_mesh(layout, panel);
  const Panel& p = layout.panels[static_cast<std::size_t>(panel)];
  const FlatPositions flat = layout.flat.middleRows(p.first_vertex, p.vertex_count);
  Distortion result;
  double area = 0;
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    const Eigen::Matrix2d edges = plane_edges(mesh, t);
    const Eigen::Matrix2d F = flat_edges(mesh.triangles, flat, t) * edges.inverse();
    const Eigen::Vector2d off = (Eigen::JacobiSVD<Eigen::Matrix2d>(F).singularValues().array() - 1).abs();
    const double weight = 0.5 * edges.determinant();
    area += weight;
    result.mean += weight * off.mean();
    result.max = std::max(result.max, off.maxCoeff());
  }
  result.mean /= area;
  return result;
}

}  // namespace softform
