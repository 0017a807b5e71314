#pragma once

#include <functional>
#include <string>

#include "softform/characters/string_candidates.hpp"
#include "softform/characters/string_placement.hpp"

namespace softform {

struct StringSelectionOptions {
  StringCandidateOptions candidates;
  /// The sparse regulariser (5.9) on the tensions: its weight k_sparse [mm^2/N^(2/alpha)] thins the candidates out to
  /// what the exchange starts from, while its smoothing falls [N].
  double sparse_weight = 1;
  double alpha = 4;
  double first_smoothing = 0.1, last_smoothing = 1e-3;
  int smoothing_steps = 5;
  /// At the last smoothing the weight is doubled until at most this many candidates are left.
  int most_candidates = 40;
  /// Weight of the tensions' squares [mm^2/N^2]: strings that draw hard against each other press the body together
  /// until it buckles.
  double tension_weight = 1;
  /// Candidates whose tensions stay under this part of the largest are dropped.
  double least_tension = 1e-2;
  /// Steps in which what does not balance at the poses of the last linearisation is taken away.
  int easing_steps = 10;
  int most_exchanges = 50;
};

struct StringSelection {
  StringLayout strings;  ///< at vertices of the boundary
  StringPoses poses;
  int candidates = 0;         ///< before thinning out
  int sparse_candidates = 0;  ///< after
  int failed_rounds = 0;      ///< linearisations whose strings were refused: no equilibrium, or no better one
};

/// Says what is being done.
using SelectionObserver = std::function<void(const std::string&)>;

/// The first stage for strings: the `count` strings from boundary vertices to points of a ring that bring the body
/// nearest to its targets, tensions >= 0. About given poses the positions are linear in the tensions, so that the best
/// tensions of any set of strings are a small non-negative least-squares problem. The sparse regulariser (5.9) on the
/// tensions of all candidates (reweighted) leaves few; of these, the string that is missed least is taken away until
/// `count` remain; then strings are exchanged against all candidates while that helps. The poses are then solved for,
/// and the model is made again about them.
StringSelection select_strings(const PlanarSolid& body, const Vec& densities, const FixedDofs& held,
                               const std::vector<Vec>& targets, const Ring& ring, int count,
                               const StringSelectionOptions& options = {}, const SelectionObserver& observer = {});

/// Takes away strings until `count` remain: each time the one whose loss the model about the poses as they are finds
/// least, after which the others are placed again.
StringPlacement thinned_strings(const PlanarSolid& body, const Vec& densities, const FixedDofs& held,
                                const std::vector<Vec>& targets, StringPlacement placement, int count,
                                const StringPlacementOptions& options = {}, const SelectionObserver& observer = {});

struct StringExchangeOptions {
  StringCandidateOptions candidates;
  StringPlacementOptions placement;
  double tension_weight = 1;
  int easing_steps = 10;
  int most_exchanges = 20;
  /// An exchange is tried where the model promises to lower the error by this part, and kept where it does.
  double least_gain = 0.02;
};

/// A second look at the choice, after the places were optimised: the model is made about the poses as they are, and the
/// string whose exchange against a candidate promises most is exchanged and all are placed again, as long as that
/// brings the poses nearer.
StringPlacement exchange_strings(const PlanarSolid& body, const Vec& densities, const FixedDofs& held,
                                 const std::vector<Vec>& targets, StringPlacement placement,
                                 const StringExchangeOptions& options = {}, const SelectionObserver& observer = {});

}  // namespace softform
