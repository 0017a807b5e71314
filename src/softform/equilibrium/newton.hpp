#pragma once

#include <functional>

#include "softform/core/report.hpp"
#include "softform/core/types.hpp"
#include "softform/equilibrium/potential.hpp"
#include "softform/linalg/sparse_factorization.hpp"

namespace softform {

struct NewtonOptions {
  /// Largest nodal force of a converged state, relative to Potential::force_scale(). Newton's last step is quadratic,
  /// so a tight bound costs one iteration more than a loose one.
  double tolerance = 1e-8;
  /// Long, because a membrane may snap through locally on the way (ears that pop out), hundreds of steps after a jump.
  int max_iterations = 150;
  /// Largest displacement of a vertex in one step, relative to Potential::length_scale(): keeps a nearly singular
  /// tangent from throwing the surface away.
  double step_cap = 0.1;
  /// First shift of an indefinite tangent, relative to its mean diagonal. A shift that only just makes it definite
  /// sends the surface far along the direction of negative curvature, into another basin.
  double first_shift = 1e-4;
  /// Sufficient decrease of the line search (Nocedal and Wright 2000, Armijo).
  double armijo = 1e-4;
  /// Shift of the tangent that handles rigid motions, relative to its mean diagonal.
  double rigid_shift = 1e-9;
};

/// A state of static equilibrium, or the best that was reached.
struct Equilibrium {
  Vec x;                          ///< (3n) [m]
  double pressure = 0;            ///< [Pa]
  double residual = 0;            ///< largest nodal force, relative to the force scale
  int negative_eigenvalues = -1;  ///< of the tangent: 0 is stable, -1 is not known
  int iterations = 0;             ///< Newton iterations spent
  Report report;
};

/// Minimises the potential from x0 by Newton's method with backtracking (3.25-3.27): the exact Hessian, projected or
/// shifted only when its Cholesky factorisation fails, so that only minima are found. `factorization` keeps its
/// symbolic analysis across calls.
Equilibrium solve_equilibrium(const Potential& potential, const Vec& x0, SparseFactorization& factorization,
                              const NewtonOptions& options = {}, const FixedDofs& fixed = {});

/// Largest norm of a nodal force, of `dimension` coordinates.
double largest_nodal_norm(ConstVec g, int dimension = 3);

/// Adds `shift` to the diagonal of K.
void shift_diagonal(SparseMatrix& K, double shift);

/// Number of negative eigenvalues of K by the inertia of L D L^T at a shift of 1e-8 of the mean diagonal, above the
/// round-off of the rigid modes; -1 when K is not finite or the factorisation breaks down.
int count_negative_eigenvalues(SparseMatrix K, SparseFactorization& factorization);

}  // namespace softform
