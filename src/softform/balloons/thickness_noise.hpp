#pragma once

#include "softform/linalg/sparse_factorization.hpp"
#include "softform/mesh/triangle_mesh.hpp"

namespace softform {

/// `count` independent standard normal numbers; the same for the same seed.
Vec independent_noise(int count, unsigned seed);

/// Gaussian random fields on a surface, of mean 0 and variance 1 everywhere, smooth over a correlation length: the
/// solutions u of
///     (kappa^2 - Laplacian) u = white noise,   kappa = sqrt(8) / correlation_length,
/// by linear elements, divided by their standard deviation (Lindgren, Rue and Lindstrom 2011). On a plane this is a
/// Matern field, whose correlation at a distance r is kappa r K_1(kappa r): 0.14 at the correlation length.
/// The variance is exact at every vertex and triangle, not a limit: it comes from two solves a vertex.
class SurfaceNoise {
 public:
  /// correlation_length [m]. Throws InputError where it is not positive.
  SurfaceNoise(const TriangleMesh& mesh, double correlation_length);

  /// A field at the vertices (n).
  Vec on_vertices(unsigned seed) const;
  /// The means over the triangles (m) of another one, again of variance 1.
  Vec on_triangles(unsigned seed) const;

 private:
  Vec unscaled(unsigned seed) const;
  void find_deviations();

  Triangles triangles_;
  Vec areas_;  // (n)
  SparseFactorization factorization_;
  Vec vertex_deviations_, triangle_deviations_;  // of the unscaled field
};

/// The thickness [m] of every triangle from standard normal numbers z,
///     h = mean exp(s z - s^2/2),   s^2 = ln(1 + variation^2),
/// which is positive, of that mean and of that coefficient of variation. Throws InputError where the mean is not
/// positive or the variation is negative.
Vec varied_thickness(ConstVec z, double mean, double variation);

}  // namespace softform
