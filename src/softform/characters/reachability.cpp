#include "softform/characters/reachability.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace softform {
namespace {

Vec with_held(const Vec& free_positions, const Vec& held_positions, const FixedDofs& clamps)
{
  if (clamps.free.size() == 0) return free_positions;
  return clamps.free.cwiseProduct(free_positions) + (1 - clamps.free.array()).matrix().cwiseProduct(held_positions);
}

}  // namespace

template <int dim>
double smallest_eigenvalue(const LoadedSolid<dim>& potential, const FixedDofs& fixed, const Vec& x,
                           SparseFactorization& factorization)
{
  SparseMatrix K;
  potential.hessian(x, K);
  fixed.project(K, K.diagonal().cwiseAbs().mean());
  if (!factorization.cholesky(K)) return std::numeric_limits<double>::quiet_NaN();
  // A start without symmetry that every mode has a part in.
  Vec v(x.size());
  for (Eigen::Index i = 0; i < v.size(); ++i) v[i] = std::sin(1.7 * double(i) + 0.3);
  fixed.project(v);
  v.normalize();
  double eigenvalue = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 60; ++k) {
    Vec w = factorization.solve(v);
    const double next = 1 / v.dot(w);
    v = w.normalized();
    if (std::abs(next - eigenvalue) < 1e-6 * next) return next;
    eigenvalue = next;
  }
  return eigenvalue;
}

template <int dim>
PoseTrace trace_pose(const LoadPath<dim>& loads, const FixedDofs& clamps, const ClampPath<dim>& path,
                     const TraceOptions& options)
{
  PoseTrace trace;
  const LoadedSolid<dim> unloaded = loads(0);
  trace.x = unloaded.body().rest_positions();
  NewtonOptions newton;
  newton.max_iterations = options.max_iterations;
  SparseFactorization factorization;
  const double at_rest = smallest_eigenvalue(unloaded, clamps, trace.x, factorization);
  trace.steps.push_back({0, at_rest, 1, 0});
  Vec velocity;  // empty where there is no step to predict from
  double t = 0, step = options.first_step;
  while (t < 1) {
    const double next = std::min(1.0, t + step), taken = next - t;
    // The last velocity as predictor, unless it makes things worse.
    const LoadedSolid<dim> potential = loads(next);
    const Vec held = path(next);
    const Vec plain = with_held(trace.x, held, clamps);
    const Vec predicted = velocity.size() > 0 ? with_held(trace.x + taken * velocity, held, clamps) : plain;
    const Vec& start = potential.value(predicted) < potential.value(plain) ? predicted : plain;
    const Equilibrium found = solve_equilibrium(potential, start, factorization, newton, clamps);
    const double moved = largest_nodal_norm(found.x - trace.x, dim);
    const bool is_snap = velocity.size() > 0 && moved > options.snap_length * potential.length_scale() &&
                         largest_nodal_norm(found.x - predicted, dim) > options.unpredicted * moved;
    if ((!found.report.converged() || is_snap) && step > options.smallest_step) {
      step = std::max(step / 2, options.smallest_step);
      continue;
    }
    const bool is_over = !found.report.converged();
    if ((is_snap || is_over) && trace.snapped_at < 0) trace.snapped_at = next;
    if (is_over) return trace;
    velocity = is_snap ? Vec() : Vec((found.x - trace.x) / taken);
    trace.x = found.x;
    t = next;
    const double eigenvalue = smallest_eigenvalue(potential, clamps, trace.x, factorization);
    trace.steps.push_back({t, eigenvalue, eigenvalue / at_rest, found.iterations});
    if (found.iterations <= options.easy_iterations) step = std::min(1.5 * step, options.largest_step);
  }
  trace.is_reached = trace.snapped_at < 0 && std::all_of(trace.steps.begin(), trace.steps.end(),
                                                         [](const auto& s) { return s.smallest_eigenvalue > 0; });
  return trace;
}

template <int dim>
PoseTrace trace_pose(const LoadedSolid<dim>& potential, const FixedDofs& clamps, const ClampPath<dim>& path,
                     const TraceOptions& options)
{
  return trace_pose<dim>([&](double) { return potential; }, clamps, path, options);
}

template double smallest_eigenvalue<2>(const LoadedSolid<2>&, const FixedDofs&, const Vec&, SparseFactorization&);
template double smallest_eigenvalue<3>(const LoadedSolid<3>&, const FixedDofs&, const Vec&, SparseFactorization&);
template PoseTrace trace_pose<2>(const LoadPath<2>&, const FixedDofs&, const ClampPath<2>&, const TraceOptions&);
template PoseTrace trace_pose<3>(const LoadPath<3>&, const FixedDofs&, const ClampPath<3>&, const TraceOptions&);
template PoseTrace trace_pose<2>(const LoadedSolid<2>&, const FixedDofs&, const ClampPath<2>&, const TraceOptions&);
template PoseTrace trace_pose<3>(const LoadedSolid<3>&, const FixedDofs&, const ClampPath<3>&, const TraceOptions&);

}  // namespace softform
