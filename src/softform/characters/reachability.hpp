#pragma once

#include <functional>
#include <vector>

#include "softform/equilibrium/loaded_solid.hpp"

namespace softform {

struct TraceOptions {
  double first_step = 0.02;  ///< of the path's parameter, which runs from 0 to 1
  double largest_step = 0.05;
  double smallest_step = 1e-4;
  int easy_iterations = 6;  ///< a step with at most as many lets the next one grow
  int max_iterations = 20;  ///< a step that needs more is halved
  /// A step that ends further from its linear prediction than this part of the way it went is halved; where it cannot
  /// be halved and a vertex still moves further than `snap_length` times the body's extent, the body has snapped.
  double unpredicted = 0.5;
  double snap_length = 1e-3;
};

/// A state on the way from rest to a pose.
struct TraceStep {
  double parameter = 0;
  /// Of the tangent with the held coordinates left out [N/m], and relative to that at rest.
  double smallest_eigenvalue = 0, relative_eigenvalue = 0;
  int iterations = 0;
};

struct PoseTrace {
  Vec x;  ///< the last state
  std::vector<TraceStep> steps;
  /// The pose is reached through stable equilibria that change continuously: no buckling on the way.
  bool is_reached = false;
  double snapped_at = -1;  ///< parameter where no continuous step was found any more, or -1
};

/// The place of the held coordinates at a parameter in [0, 1], as positions of all vertices: others are ignored.
template <int dim>
using ClampPath = std::function<Vec(double parameter)>;

/// The body under its loads at a parameter in [0, 1]: pins that are led to their places, strings that are drawn.
template <int dim>
using LoadPath = std::function<LoadedSolid<dim>(double parameter)>;

/// Follows the equilibrium from rest while the clamps move along a path (load continuation), and watches the smallest
/// eigenvalue of the tangent: a body that is to be posed by hand has to come to the pose without snapping through. A
/// snap is said, and ends the trace where Newton's method finds no equilibrium behind it.
template <int dim>
PoseTrace trace_pose(const LoadedSolid<dim>& potential, const FixedDofs& clamps, const ClampPath<dim>& path,
                     const TraceOptions& options = {});

/// The same while the loads change too. At 0 they leave the body at rest.
template <int dim>
PoseTrace trace_pose(const LoadPath<dim>& loads, const FixedDofs& clamps, const ClampPath<dim>& path,
                     const TraceOptions& options = {});

/// The smallest eigenvalue of the tangent at x on the free coordinates [N/m], by inverse iteration; NaN when the
/// tangent is not positive definite.
template <int dim>
double smallest_eigenvalue(const LoadedSolid<dim>& potential, const FixedDofs& fixed, const Vec& x,
                           SparseFactorization& factorization);

}  // namespace softform
