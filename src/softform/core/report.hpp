#pragma once

#include <functional>
#include <string>
#include <vector>

#include "softform/core/types.hpp"

#include "softform/core/types.hpp"

namespace softform {

/// Why a solver stopped. Not converging is an outcome, not an exception.
enum class Termination { Converged, IterationLimit, TimeLimit, Stalled, Infeasible, NotFinite, Interrupted };

/// The outcome in words, for messages and CSV.
const char* to_string(Termination termination);

/// One line of a solver's trace. Units are the solver's own; infeasibility and stationarity are dimensionless.
struct Iterate {
  int k = 0;
  double objective = 0;
  double stationarity = 0;
  double infeasibility = 0;
  double step_norm = 0;
  double elapsed_s = 0;
  int linear_solves = 0;  ///< so far, see Evaluations
  double damping = 0;     ///< what holds the step back, in the method's own units; 0 where it has none
  /// The point itself, while an observer looks at it; null in a trace, and where a method does not show it.
  const Vec* z = nullptr;
};

/// What a solve cost.
struct Evaluations {
  int value = 0;
  int gradient = 0;
  int constraint = 0;
  int jacobian = 0;
  int hessian = 0;
  int linear_solve = 0;  ///< sparse factorisations, those for equilibria and adjoints too
};

/// Seconds that a solve spent on its parts; 0 where a solver does not measure them.
struct PhaseTimes {
  double assembly = 0;       ///< derivatives, and the matrices made from them
  double factorization = 0;  ///< of the matrices of the steps
  double solve = 0;          ///< with these factors
  double restoration = 0;    ///< of feasibility, by the programme: equilibria that are solved for again
};

/// What every solver returns beside its result.
struct Report {
  Termination termination = Termination::IterationLimit;
  std::string message;
  std::vector<Iterate> trace;
  Evaluations evaluations;
  PhaseTimes times;

  bool converged() const { return termination == Termination::Converged; }
};

/// Called once an iteration; returning false asks the solver to stop with Termination::Interrupted.
using IterationObserver = std::function<bool(const Iterate&)>;

}  // namespace softform
