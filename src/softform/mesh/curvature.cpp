#include "softform/mesh/curvature.hpp"

#include <algorithm>

#include "softform/mesh/distance.hpp"
#include "softform/mesh/laplacian.hpp"

namespace softform {

Vec mean_curvature(const TriangleMesh& mesh)
{
  const Vec x = flatten(mesh.vertices);
  const Positions laplacian = cotangent_laplacian(mesh) * mesh.vertices;
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
