#include "softform/balloons/thickness_noise.hpp"

#include <cmath>
#include <random>
#include <vector>

#include <fmt/format.h>

#include "softform/core/error.hpp"
#include "softform/mesh/laplacian.hpp"

namespace softform {

Vec independent_noise(int count, unsigned seed)
{
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  return Vec::NullaryExpr(count, [&] { return normal(generator); });
}

// (kappa^2 M + L) u = M^(1/2) w with the lumped mass M: the covariance of u is A^-1 M A^-1.
SurfaceNoise::SurfaceNoise(const TriangleMesh& mesh, double correlation_length)
    : triangles_(mesh.triangles), areas_(vertex_areas(flatten(mesh.vertices), mesh.triangles))
{
  if (!(correlation_length > 0) || !std::isfinite(correlation_length))
    throw InputError(fmt::format("the correlation length is {} m: it must be positive", correlation_length));
  SparseMatrix A = cotangent_laplacian(mesh);
  A.diagonal() += 8 / (correlation_length * correlation_length) * areas_;
  if (!factorization_.cholesky(A))
    throw InputError("the surface has degenerate triangles: remesh it before asking for noise on it");
  find_deviations();
}

void SurfaceNoise::find_deviations()
{
  const auto n = static_cast<int>(areas_.size());
  std::vector<std::vector<int>> triangles_of(static_cast<std::size_t>(n));
  for (int t = 0; t < triangles_.rows(); ++t)
    for (int k = 0; k < 3; ++k) triangles_of[static_cast<std::size_t>(triangles_(t, k))].push_back(t);

  Vec vertex_variances(n), triangle_variances = Vec::Zero(triangles_.rows());
  for (int j = 0; j < n; ++j) {
    const Vec response = factorization_.solve(Vec::Unit(n, j)).cwiseProduct(areas_);
    const Vec covariance = factorization_.solve(response);
    vertex_variances[j] = covariance[j];
    for (const int t : triangles_of[static_cast<std::size_t>(j)])
      for (int k = 0; k < 3; ++k) triangle_variances[t] += covariance[triangles_(t, k)] / 9;
  }
  vertex_deviations_ = vertex_variances.cwiseSqrt();
  triangle_deviations_ = triangle_variances.cwiseSqrt();
}

Vec SurfaceNoise::unscaled(unsigned seed) const
{
  const Vec w = independent_noise(static_cast<int>(areas_.size()), seed);
  return factorization_.solve(areas_.cwiseSqrt().cwiseProduct(w));
}

Vec SurfaceNoise::on_vertices(unsigned seed) const { return unscaled(seed).cwiseQuotient(vertex_deviations_); }

Vec SurfaceNoise::on_triangles(unsigned seed) const
{
  const Vec u = unscaled(seed);
  Vec means(triangles_.rows());
  for (int t = 0; t < triangles_.rows(); ++t) means[t] = u(triangles_.row(t).transpose()).mean();
  return means.cwiseQuotient(triangle_deviations_);
}

Vec varied_thickness(ConstVec z, double mean, double variation)
{
  if (!(mean > 0) || !(variation >= 0) || !std::isfinite(mean * variation))
    throw InputError(
        fmt::format("the thickness is {} m with a variation of {}: the first must be positive, the "
                    "second not negative",
                    mean, variation));
  const double s2 = std::log1p(variation * variation), s = std::sqrt(s2);
  return mean * (s * z.array() - 0.5 * s2).exp();
}

}  // namespace softform
