#pragma once

#include "softform/core/types.hpp"
#include "softform/linalg/sparse_factorization.hpp"

namespace softform {

/// The changes of shape v_i that an equilibrium resists least: the smallest eigenvalues of K v = sigma M v with v^t M v
/// = 1, rigid motions left out, in ascending order.
struct SoftModes {
  Vec stiffness;           ///< sigma_i (k), in units of K over those of M
  Eigen::MatrixXd shapes;  ///< v_i (3n, k)
};

/// The `count` softest modes at a stable equilibrium x (3n) with tangent K, both triangles stored, and lumped masses
/// (3n), by Lanczos' method on the inverse (Spectra); fewer where there are not so many. Nothing, with k = 0, where K
/// is not positive definite but for rigid motions. The factorisation keeps its symbolic analysis.
SoftModes soft_modes(const SparseMatrix& K, const Vec& masses, ConstVec x, int count,
                     SparseFactorization& factorization);

}  // namespace softform
