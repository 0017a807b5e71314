#include "softform/optimizers/optimality.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "softform/core/error.hpp"
#include "softform/optimizers/kkt_system.hpp"

namespace softform {
namespace {

double largest(ConstVec v) { return v.size() > 0 ? v.cwiseAbs().maxCoeff() : 0; }

/// |z - P(z - v)|, NaN where an entry is.
double projected(ConstVec z, ConstVec v, ConstVec lower, ConstVec upper)
{
  if (!v.allFinite()) return std::nan("");
  // z - P(z - v) without the difference of large numbers.
  return largest(v.cwiseMax(z - upper).cwiseMin(z - lower));
}

Vec fitted_multipliers(ConstVec z, ConstVec g, SparseMatrix J, ConstVec lower, ConstVec upper)
{
  constexpr double at_bound = 1e-7;  // relative
  Vec free = Vec::Ones(z.size());
  for (Eigen::Index i = 0; i < z.size(); ++i) {
    const double margin = at_bound * (1 + std::abs(z[i]));
    if (z[i] - lower[i] < margin || upper[i] - z[i] < margin) free[i] = 0;
  }
  J = J * free.asDiagonal();
  return least_squares_multipliers(g.cwiseProduct(free), J);
}

}  // namespace

bool Optimality::is_finite() const
{
  return std::isfinite(objective) && std::isfinite(stationarity) && std::isfinite(infeasibility);
}

Optimality measure_optimality(const NonlinearProgram& program, ConstVec z, const Vec& lagrange_multipliers)
{
  const Vec lower = program.lower_bounds(), upper = program.upper_bounds();
  Optimality found;
  Vec g, c(0);
  SparseMatrix J(0, program.variable_count());
  found.objective = program.objective(z);
  program.objective_gradient(z, g);
  if (program.constraint_count() > 0) {
    program.constraints(z, c);
    program.constraint_jacobian(z, J);
  }
  const bool is_finite = g.allFinite() && c.allFinite() && J.coeffs().allFinite();
  found.lagrange_multipliers = lagrange_multipliers;
  if (lagrange_multipliers.size() != c.size())
    found.lagrange_multipliers = is_finite ? fitted_multipliers(z, g, J, lower, upper) : Vec::Zero(c.size());
  found.bound_multipliers = g + J.transpose() * found.lagrange_multipliers;
  found.stationarity = projected(z, found.bound_multipliers / std::max(1.0, largest(g)), lower, upper);
  const double outside = std::max({0.0, (lower - z).maxCoeff(), (z - upper).maxCoeff()});
  found.infeasibility = c.allFinite() ? std::max(largest(c), outside) : std::nan("");
  const double J_size = J.nonZeros() > 0 ? std::max(1.0, J.coeffs().abs().maxCoeff()) : 1;
  found.infeasibility_gradient = projected(z, J.transpose() * c / J_size, lower, upper);
  return found;
}

bool has_no_way_to_feasibility(const Optimality& found)
{
  constexpr double small = 1e-6;
  return found.infeasibility_gradient <= small * std::min(1.0, found.infeasibility);
}

void judge(const NonlinearProgram& program, const Tolerances& tolerances, Solution& solution)
{
  Report& report = solution.report;
  const Optimality found = measure_optimality(program, solution.z, solution.lagrange_multipliers);
  solution.objective = found.objective;
  solution.lagrange_multipliers = found.lagrange_multipliers;
  solution.bound_multipliers = found.bound_multipliers;
  if (!report.trace.empty()) {
    Iterate& last = report.trace.back();
    last.objective = found.objective;
    last.stationarity = found.stationarity;
    last.infeasibility = found.infeasibility;
  }
  const bool is_infeasible = !(found.infeasibility <= tolerances.infeasibility);
  if (!found.is_finite())
    report.termination = Termination::NotFinite;
  else if (is_infeasible && has_no_way_to_feasibility(found))
    report.termination = Termination::Infeasible;
  else if (report.converged() && (is_infeasible || !(found.stationarity <= tolerances.stationarity)))
    report.termination = Termination::Stalled;
  report.message += fmt::format("; stationarity {:.1e}, infeasibility {:.1e}", found.stationarity, found.infeasibility);
}

void require(const NonlinearProgram& program, const char* method, bool takes_constraints, bool takes_bounds)
{
  const int n = program.variable_count();
  const Vec z = program.initial_point(), lower = program.lower_bounds(), upper = program.upper_bounds();
  const auto refuse = [&](const std::string& reason) {
    throw InputError(fmt::format("{}: {} {}", program.name(), method, reason));
  };
  if (n < 1 || z.size() != n || lower.size() != n || upper.size() != n)
    refuse(fmt::format("needs a start and bounds of {} variables", n));
  if (!z.allFinite()) refuse("needs a start that is finite");
  for (int i = 0; i < n; ++i)
    if (!(lower[i] <= upper[i])) refuse(fmt::format("needs bounds in order; those of variable {} are not", i));
  if (!takes_constraints && program.constraint_count() > 0)
    refuse("takes no constraints: use sqp, augmented_lagrangian or ipopt");
  const bool has_bounds = (lower.array() > -HUGE_VAL).any() || (upper.array() < HUGE_VAL).any();
  if (!takes_bounds && has_bounds) refuse("takes no bounds: use gradient_projection, augmented_lagrangian or ipopt");
}

}  // namespace softform
