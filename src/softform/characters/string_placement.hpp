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

/// The equilibria from the positions given, whose held coordinates stay where they are.
StringPoses settled(const PlanarSolid& body, const Vec& densities, const FixedDofs& held, const StringLayout& strings,
                    const std::vector<Vec>& start_positions);

struct StringPlacementOptions {
  StringPlacementWeights weights;
  /// A place moves by at most the kernels' radius in a round, then its side and kernels are taken anew.
  int rounds = 10;
  int iterations_per_round = 20;
  /// A round that lowers the squared error by less than this part of it is the last.
  double least_gain = 1e-2;
};

struct StringPlacement {
  StringLayout strings;  ///< places on the boundary itself
  StringPoses poses;
  int iterations = 0;
  int failed_equilibria = 0;  ///< inside the optimisation; each rejected a step
};

/// The second stage for strings (5.4.3): places slide on the boundary, pulleys on the ring, and tensions change with
/// them until the poses come nearest to the targets, by ReducedGaussNewton on StringPlacementProgram. A round whose
/// true equilibria are no nearer than those before is undone.
StringPlacement place_strings(const PlanarSolid& body, const Vec& densities, const FixedDofs& held,
                              const std::vector<Vec>& targets, const StringLayout& start,
                              const std::vector<Vec>& start_positions, const StringPlacementOptions& options = {});

}  // namespace softform
