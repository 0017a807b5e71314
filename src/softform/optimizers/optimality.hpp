#pragma once

#include "softform/optimizers/optimizer.hpp"

namespace softform {

/// How far a point is from the first-order conditions of a programme, in largest norms.
struct Optimality {
  double objective = 0;
  /// |z - P(z - (g + J^t lambda) / max(1, |g|))|, P the projection into the bounds: what is left of the gradient where
  /// there are none. Scaled inside P: a box is small beside a large gradient, and would hide it.
  double stationarity = 0;
  double infeasibility = 0;  ///< |c|, or the violation of a bound
  /// |z - P(z - J^t c / max(1, |J|))|: next to zero where |c|^2 is at a minimum, whether c is zero or not.
  double infeasibility_gradient = 0;
  Vec lagrange_multipliers;  ///< (constraint_count)
  Vec bound_multipliers;     ///< (variable_count) g + J^t lambda

  bool is_finite() const;
};

/// Evaluates the programme at z. Where no multipliers are given, those that fit best on the variables off their bounds.
Optimality measure_optimality(const NonlinearProgram& program, ConstVec z, const Vec& lagrange_multipliers = {});

/// True at an infeasible point where |c|^2 is stationary to 1e-6.
bool has_no_way_to_feasibility(const Optimality& found);

/// How exactly a claim of convergence has to hold. Methods stop by measures of their own, so that less is asked of the
/// result than of the method.
struct Tolerances {
  double stationarity = 1e-6;
  double infeasibility = 1e-6;
};

/// What a method's claim is worth: evaluates the programme at solution.z, fills in objective and multipliers, and
/// replaces a claim of convergence by NotFinite, Infeasible or Stalled where the conditions do not hold. The last line
/// of the trace becomes what was found.
void judge(const NonlinearProgram& program, const Tolerances& tolerances, Solution& solution);

/// Throws InputError when the programme has constraints or bounds that the method does not take, or sizes that do not
/// fit together, or a start that is not finite.
void require(const NonlinearProgram& program, const char* method, bool takes_constraints, bool takes_bounds);

}  // namespace softform
