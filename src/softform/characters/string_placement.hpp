#pragma once

#include "softform/characters/string_placement_program.hpp"

namespace softform {

/// True equilibria of a body's poses under strings.
struct StringPoses {
  std::vector<Vec> positions;    ///< (2n) [m]
  int negative_eigenvalues = 0;  ///< of the free coordinates' tangents, all poses together: 0 is stable
  double residual = 0;           ///< largest unbalanced nodal force of all poses, relative to the force scale
  int failed_equilibria = 0;     ///< poses whose equilibrium was not found
};

/// The equilibria from the positions given, whose clamped coordinates stay where they are. Where the positions are far
/// from balance under these strings, the forces that are missing there act as dead loads and are taken away in
/// `easing_steps`, so that a pose stays on the branch of equilibria that it is near to.
StringPoses settled(const PosedBody& posed, const StringLayout& strings, const std::vector<Vec>& start_positions,
                    int easing_steps = 1);

struct StringPlacementOptions {
  StringPlacementWeights weights;
  /// A place moves by at most the kernels' radius in a round, then its side and kernels are taken anew.
  int rounds = 10;
  int iterations_per_round = 20;
  /// A round that lowers the objective by less than this part of it is the last.
  double least_gain = 1e-2;
  /// When places are moved onto the boundary itself, the poses follow in as many steps.
  int easing_steps = 4;
};

struct StringPlacement {
  StringLayout strings;  ///< places on the boundary itself
  StringPoses poses;
  int iterations = 0;
  int failed_equilibria = 0;  ///< inside the optimisation; each rejected a step or a round
};

/// The second stage for strings (5.4.3): places slide on the boundary, pulleys on the ring, and tensions change with
/// them until the poses come nearest to the targets, by ReducedGaussNewton on StringPlacementProgram. A round after
/// which an equilibrium is not found is undone, and the last. An observer that returns false ends it with the round it
/// is in.
StringPlacement place_strings(const PosedBody& posed, const StringLayout& start,
                              const std::vector<Vec>& start_positions, const StringPlacementOptions& options = {},
                              const IterationObserver& observer = {});

}  // namespace softform
