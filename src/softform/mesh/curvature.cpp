#include "softform/mesh/curvature.hpp"

#include <algorithm>

#include <Eigen/Geometry>

#include "softform/mesh/distance.hpp"

namespace softform {

Vec mean_curvature(const TriangleMesh& mesh)
{
  const Vec x = flatten(mesh.vertices);
  Positions laplacian = Positions::Zero(mesh.vertex_count(), 3);
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const int i = mesh.triangles(t, k), j = mesh.triangles(t, (k + 1) % 3), o = mesh.triangles(t, (k + 2) % 3);
      const Vec3 a = vertex(x, i) - vertex(x, o), b = vertex(x, j) - vertex(x, o);
      const Eigen::RowVector3d edge = (vertex(x, i) - vertex(x, j)).transpose();
      const double half_cotangent = 0.5 * a.dot(b) / a.cross(b).norm();
      laplacian.row(i) += half_cotangent * edge;
      laplacian.row(j) -= half_cotangent * edge;
    }
  }
  const Positions normals = vertex_normals(x, mesh.triangles);
  return 0.5 * laplacian.cwiseProduct(normals).rowwise().sum().cwiseQuotient(vertex_areas(x, mesh.triangles));
}

double mirror_asymmetry(const TriangleMesh& mesh)
{
  const SurfaceDistance surface(mesh);
  // The centroid of the surface, not of the vertices, which need not be spread evenly.
  const Vec areas = vertex_areas(flatten(mesh.vertices), mesh.triangles);
  const Eigen::RowVector3d centroid = areas.transpose() * mesh.vertices / areas.sum();
  double largest = 0;
  for (int axis = 0; axis < 3; ++axis) {
    Positions mirrored = mesh.vertices;
    mirrored.col(axis) = 2 * centroid[axis] - mirrored.col(axis).array();
    largest = std::max(largest, surface.distances(mirrored).maxCoeff());
  }
  return largest;
}

}  // namespace softform
