#include <algorithm>
#include <cmath>
#include <numbers>

#include "softform/inflatables/symmetric_dirichlet.hpp"
#include "softform/linalg/sparse_factorization.hpp"

namespace softform {

FlatPositions tutte_interior(const TriangleMesh& mesh, const std::vector<int>& loop, const FlatPositions& boundary)
{
  const auto neighbours = vertex_neighbours(mesh.triangles, mesh.vertex_count());
  std::vector<bool> is_given(static_cast<std::size_t>(mesh.vertex_count()), false);
  FlatPositions flat = FlatPositions::Zero(mesh.vertex_count(), 2);
  for (std::size_t j = 0; j < loop.size(); ++j) {
    is_given[static_cast<std::size_t>(loop[j])] = true;
    flat.row(loop[j]) = boundary.row(static_cast<Eigen::Index>(j));
  }
  std::vector<int> unknown(is_given.size(), -1), vertices;
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    if (is_given[static_cast<std::size_t>(v)]) continue;
    unknown[static_cast<std::size_t>(v)] = static_cast<int>(vertices.size());
    vertices.push_back(v);
  }
  if (vertices.empty()) return flat;

  const auto n = static_cast<Eigen::Index>(vertices.size());
  std::vector<Eigen::Triplet<double>> entries;
  FlatPositions right_side = FlatPositions::Zero(n, 2);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto& ring = neighbours[static_cast<std::size_t>(vertices[static_cast<std::size_t>(i)])];
    entries.emplace_back(i, i, static_cast<double>(ring.size()));
    for (const int w : ring) {
      if (is_given[static_cast<std::size_t>(w)])
        right_side.row(i) += flat.row(w);
      else
        entries.emplace_back(i, unknown[static_cast<std::size_t>(w)], -1);
    }
  }
  SparseMatrix laplacian(n, n);
  laplacian.setFromTriplets(entries.begin(), entries.end());
  SparseFactorization factorization;
  factorization.cholesky(laplacian);  // positive definite: every panel has a boundary
  const Vec x = factorization.solve(right_side.col(0)), y = factorization.solve(right_side.col(1));
  for (Eigen::Index i = 0; i < n; ++i) flat.row(vertices[static_cast<std::size_t>(i)]) << x[i], y[i];
  return flat;
}

FlatPositions tutte_disc(const TriangleMesh& mesh, const std::vector<int>& loop)
{
  const auto b = static_cast<Eigen::Index>(loop.size());
  Vec arcs(b + 1);
  arcs[0] = 0;
  for (Eigen::Index j = 0; j < b; ++j)
    arcs[j + 1] = arcs[j] + (mesh.vertices.row(loop[static_cast<std::size_t>((j + 1) % b)]) -
                             mesh.vertices.row(loop[static_cast<std::size_t>(j)]))
                                .norm();
  const double radius = std::sqrt(surface_area(flatten(mesh.vertices), mesh.triangles) / std::numbers::pi);
  FlatPositions circle(b, 2);
  for (Eigen::Index j = 0; j < b; ++j) {
    const double angle = 2 * std::numbers::pi * arcs[j] / arcs[b];
    circle.row(j) << radius * std::cos(angle), radius * std::sin(angle);
  }
  return tutte_interior(mesh, loop, circle);
}

}  // namespace softform
