#include "softform/core/report.hpp"

namespace softform {

const char* to_string(Termination termination)
{
  switch (termination) {
    case Termination::Converged: return "converged";
    case Termination::IterationLimit: return "iteration limit";
    case Termination::TimeLimit: return "time limit";
    case Termination::Stalled: return "stalled";
    case Termination::Infeasible: return "infeasible";
    case Termination::NotFinite: return "not finite";
    case Termination::Interrupted: return "interrupted";
  }
  return "unknown";
}

}  // namespace softform
