#include "softform/mesh/laplacian.hpp"

#include <vector>

#include <Eigen/Geometry>

namespace softform {

SparseMatrix cotangent_laplacian(const TriangleMesh& mesh)
{
  const Vec x = flatten(mesh.vertices);
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(12 * static_cast<std::size_t>(mesh.triangle_count()));
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const int i = mesh.triangles(t, k), j = mesh.triangles(t, (k + 1) % 3), o = mesh.triangles(t, (k + 2) % 3);
      const Vec3 a = vertex(x, i) - vertex(x, o), b = vertex(x, j) - vertex(x, o);
      const double weight = 0.5 * a.dot(b) / a.cross(b).norm();
      entries.insert(entries.end(), {{i, i, weight}, {j, j, weight}, {i, j, -weight}, {j, i, -weight}});
    }
  }
  SparseMatrix L(mesh.vertex_count(), mesh.vertex_count());
  L.setFromTriplets(entries.begin(), entries.end());
  return L;
}

}  // namespace softform
