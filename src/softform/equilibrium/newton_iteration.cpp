#include "softform/equilibrium/newton_iteration.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "softform/core/interrupt.hpp"

namespace softform {

double TangentShift::raise()
{
  const double before = beta_;
  beta_ = std::max(4 * beta_, first_);
  was_raised_ = true;
  return beta_ - before;
}

void TangentShift::relax(double residual)
{
  constexpr double near_equilibrium = 0.1;
  const bool is_dispensable = residual < near_equilibrium && !was_raised_;
  beta_ = beta_ > 1e-2 * first_ && !is_dispensable ? 0.2 * beta_ : 0;
  was_raised_ = false;
}

void finish(Equilibrium& state, Termination termination, std::string message)
{
  state.report.termination = termination;
  state.report.message = std::move(message);
}

bool is_finished(Equilibrium& state, int k, double energy, bool is_balanced, const NewtonOptions& options)
{
  state.iterations = k;
  if (!std::isfinite(energy) || !std::isfinite(state.residual)) {
    finish(state, Termination::NotFinite, "energy or forces are not finite");
  } else if (is_balanced) {
    finish(state, Termination::Converged, fmt::format("residual {:.1e}", state.residual));
  } else if (k >= options.max_iterations) {
    finish(state, Termination::IterationLimit, fmt::format("{} iterations, residual {:.1e}", k, state.residual));
  } else if (interrupted()) {
    finish(state, Termination::Interrupted, "interrupted");
  } else {
    return false;
  }
  return true;
}

}  // namespace softform
