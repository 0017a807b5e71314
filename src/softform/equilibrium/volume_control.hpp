#pragma once

#include <functional>

#include "softform/equilibrium/pressurized_membrane.hpp"

namespace softform {

/// A converged step of an inflation.
struct InflationStep {
  double volume = 0;    ///< [m^3]
  double pressure = 0;  ///< [Pa]
  int iterations = 0;   ///< Newton iterations of this step
};

struct InflationOptions {
  /// Growth of the cube root of the volume in the first step and at most in any one, as a fraction of the rest's.
  double first_step = 1;
  double largest_step = 0.5;
  /// Smallest step before the path is given up.
  double smallest_step = 1e-4;
  /// Step over a limit point of the pressure when a pressure is sought: the peak is then known to about 1e-3 of itself.
  double limit_point_step = 0.02;
  /// Newton iterations of a step that count as easy (the next step grows) and as hopeless (the step is halved).
  int easy_iterations = 6;
  int most_iterations = 40;
  /// Relative residual of the steps on the way: they need only stay on the path.
  double path_tolerance = 1e-3;
  NewtonOptions newton;
};

/// Called with the state after every step of an inflation; returning false ends it with Termination::Interrupted.
using InflationObserver = std::function<bool(const InflationStep&, const Vec& x)>;

/// Equilibrium at a prescribed volume from x0: the volume is a constraint and the pressure its multiplier, so that
/// limit points of the pressure are passed as ordinary points. Stability and `negative_eigenvalues` are those at fixed
/// volume, from the inertia of the bordered matrix.
/// `dx_dV` receives the tangent of the path (3n) [1/m^2], `dp_dV` that of the pressure, at the solution.
Equilibrium solve_at_volume(const PressurizedMembrane& balloon, double volume, const Vec& x0, double pressure0,
                            SparseFactorization& factorization, const NewtonOptions& options = {},
                            const FixedDofs& fixed = {}, Vec* dx_dV = nullptr, double* dp_dV = nullptr);

/// Inflates from rest to `volume` [m^3] by volume control, with tangent prediction and steps that adapt.
Equilibrium inflate_to_volume(const PressurizedMembrane& balloon, double volume, SparseFactorization& factorization,
                              const InflationOptions& options = {}, const FixedDofs& fixed = {},
                              const InflationObserver& observer = {});

/// Inflates from rest until the pressure first reaches `pressure` [Pa]; through limit points when it is reached only
/// behind one, and to within options.limit_point_step of one. Termination::Infeasible when it is not reached before the
/// volume is `largest_volume_ratio` times that at rest; `x` is then the last state.
Equilibrium inflate_to_pressure(const PressurizedMembrane& balloon, double pressure, SparseFactorization& factorization,
                                const InflationOptions& options = {}, double largest_volume_ratio = 1000,
                                const FixedDofs& fixed = {}, const InflationObserver& observer = {});

}  // namespace softform
