#pragma once

#include <functional>
#include <string>
#include <vector>

#include "softform/characters/sparse_actuation_program.hpp"
#include "softform/core/report.hpp"

namespace softform {

struct SparseActuationOptions {
  double alpha = 4;
  /// The smoothing of (5.9) falls geometrically from the size of the forces to where it no longer shows [N].
  double first_smoothing = 1;
  double last_smoothing = 1e-3;
  int smoothing_steps = 6;
  /// Candidates whose force stays under this part of the largest are no actuators.
  double least_force = 1e-2;
  /// Actuators nearer than this many mean boundary edges are merged.
  double merging_distance = 1.5;
  /// Inner steps of the augmented Lagrangian for one smoothing; few smoothings need that many.
  int max_iterations = 80;
  /// The same for a refit, which starts further away.
  int max_refit_iterations = 250;
  /// Coordinates that stay at rest, such as those of a foot in its stand. Their vertices are no candidates.
  FixedDofs held;
};

/// Where a body is held by point forces, and the poses that they give it.
struct PointActuation {
  std::vector<int> vertices;   ///< the actuators
  std::vector<Vec> positions;  ///< (2n) a pose [m]
  std::vector<Vec> forces;     ///< (2 actuators) a pose [N]
  double squared_error = 0;    ///< 1/2 sum_i |x^i - t^i|^2 [mm^2]
  double infeasibility = 0;    ///< largest unbalanced nodal force [N]
  int iterations = 0;          ///< of the augmented Lagrangian

  int count() const { return static_cast<int>(vertices.size()); }
  /// Whether the forces balance, to a thousandth of the largest. Poses that are not in balance may be as near to the
  /// targets as they like.
  bool is_balanced() const;
};

/// Asks a stage to stop when it returns false; the text says what is being done.
using StageObserver = std::function<bool(const std::string&)>;

/// The first stage (5.4.2): forces at few of the boundary's vertices that bring the body to the targets, by the
/// augmented Lagrangian method on SparseActuationProgram while the smoothing falls. `weight` is k_sparse
/// [mm^2/N^(2/alpha)].
PointActuation sparse_actuation(const PlanarSolid& body, const std::vector<Vec>& targets, double weight,
                                const SparseActuationOptions& options = {});

/// The best forces at the vertices given, without a regulariser, from the poses of `start`.
PointActuation refitted(const PlanarSolid& body, const std::vector<Vec>& targets, const std::vector<int>& vertices,
                        const PointActuation& start, const SparseActuationOptions& options = {});

/// How many actuators are wanted.
struct ActuatorRange {
  int fewest, most;
};

/// Actuators whose number lies in the range: bisection on log k_sparse, merging of neighbours, then backward
/// elimination of the actuator that is missed least.
/// Throws InputError when the range is empty, holds fewer than two actuators or more than the boundary has vertices.
PointActuation actuation_in_range(const PlanarSolid& body, const std::vector<Vec>& targets, const ActuatorRange& range,
                                  const SparseActuationOptions& options = {}, const StageObserver& observer = {});

}  // namespace softform
