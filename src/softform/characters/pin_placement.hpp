#pragma once

#include "softform/characters/pin_placement_program.hpp"
#include "softform/characters/sparse_actuation.hpp"

namespace softform {

/// Pins at the actuators found by the first stage, held so that they pull with its forces.
Pins pins_from(const PlanarSolid& body, const PointActuation& actuation, const PinPlacementWeights& weights = {});

/// The pins of a pose as the springs that act on the body.
std::vector<Pin<2>> pins_of_pose(const PlanarSolid& body, const Pins& pins, std::size_t pose, double stiffness);

struct PinPlacementOptions {
  PinPlacementWeights weights;
  /// A place moves by at most the kernels' radius in a round, then its side and kernels are taken anew.
  int rounds = 5;
  int iterations_per_round = 15;
  /// A round that lowers the objective by less than this part of it is the last.
  double least_gain = 1e-2;
  /// Coordinates that stay at rest.
  FixedDofs held;
};

struct PinPlacement {
  Pins pins;                     ///< places on the boundary itself
  std::vector<Vec> positions;    ///< true equilibria under these pins (2n) [m]
  int negative_eigenvalues = 0;  ///< of all poses together: 0 is stable
  double residual = 0;           ///< largest unbalanced nodal force of all poses, relative to the force scale
  int iterations = 0;
  int failed_equilibria = 0;  ///< inside the optimisation; each rejected a step
  bool is_settled = false;    ///< the positions are equilibria: false where a pose has none under its pins
};

/// The second stage (5.4.3): the pins slide on the boundary and are held where the poses come nearest to the targets,
/// by Gauss-Newton steps on the equilibria of PinPlacementProgram. With `rounds` = 0 the pins' own equilibria. An
/// observer that returns false ends it with what it has.
PinPlacement place_pins(const PlanarSolid& body, const Vec& densities, const std::vector<Vec>& targets,
                        const Pins& start, const std::vector<Vec>& start_positions,
                        const PinPlacementOptions& options = {}, const IterationObserver& observer = {});

}  // namespace softform
