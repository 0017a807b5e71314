#include "softform/balloons/thickness_levelling.hpp"

#include <cmath>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "softform/core/error.hpp"
#include "softform/linalg/sparse_factorization.hpp"
#include "softform/mesh/curvature.hpp"
#include "softform/mesh/laplacian.hpp"

namespace softform {

// With the Laplacian -M^-1 L, M the lumped mass:  (M + l^4 L M^-1 L) dh = -l^4 L (2 H).
Vec levelled_film(const TriangleMesh& mould, double levelling_length)
{
  if (!(levelling_length > 0) || !std::isfinite(levelling_length))
    throw InputError(fmt::format("the levelling length is {} m: it must be positive", levelling_length));
  const Vec areas = vertex_areas(flatten(mould.vertices), mould.triangles);
  const SparseMatrix L = cotangent_laplacian(mould);
  const double l4 = std::pow(levelling_length, 4);
  const SparseMatrix divided = areas.cwiseInverse().asDiagonal() * L;
  SparseMatrix A = l4 * (L * divided);
  A.diagonal() += areas;
  SparseFactorization factorization;
  if (!factorization.cholesky(A)) throw InputError("the mould has degenerate triangles: remesh it before it is coated");
  return factorization.solve(-2 * l4 * (L * mean_curvature(mould)));
}

Vec standardized_on_triangles(const TriangleMesh& mesh, ConstVec vertex_values)
{
  Vec values(mesh.triangle_count()), weights(mesh.triangle_count());
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    const Eigen::RowVector3i corners = mesh.triangles.row(t);
    const Vec3 a = mesh.vertices.row(corners[0]), b = mesh.vertices.row(corners[1]), c = mesh.vertices.row(corners[2]);
    values[t] = (vertex_values[corners[0]] + vertex_values[corners[1]] + vertex_values[corners[2]]) / 3;
    weights[t] = (b - a).cross(c - a).norm();
  }
  weights /= weights.sum();
  const double mean = weights.dot(values);
  values.array() -= mean;
  const double variance = weights.dot(values.cwiseAbs2());
  if (!(variance > 1e-24 * mean * mean))
    throw InputError("the values are constant: they have no variance to scale to 1");
  return values / std::sqrt(variance);
}

}  // namespace softform
