#pragma once

#include "softform/characters/sparse_actuation.hpp"
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
  double tension_weight = 20;
  /// Candidates whose tensions stay under this part of the largest are dropped.
  double least_tension = 1e-2;
  /// Steps in which what does not balance at the targets is taken away.
  int easing_steps = 10;
  int most_exchanges = 50;
};

struct StringSelection {
  StringLayout strings;  ///< at vertices of the boundary
  StringPoses poses;
  int candidates = 0;         ///< before thinning out
  int sparse_candidates = 0;  ///< after
  double expected_error = 0;  ///< of the linear model: 1/2 sum_i |x^i - t^i|^2 and its tension term [mm^2]
};

/// The first stage for strings: `count` strings from boundary vertices to points of a ring that bring the body nearest
/// to its targets, tensions >= 0. About the targets the positions are nearly linear in the tensions (TensionModel), so
/// that any set of strings is judged by a small quadratic programme. The sparse regulariser (5.9) on the tensions of
/// all candidates leaves few of them; of these, the string that is missed least is taken away until `count` remain;
/// then strings are exchanged against other candidates as long as that helps. The poses are true equilibria.
/// An observer that returns false ends the exchanges. Throws InputError when there are fewer candidates than strings
/// wanted.
StringSelection select_strings(const PosedBody& posed, const Ring& ring, int count,
                               const StringSelectionOptions& options = {}, const StageObserver& observer = {});

}  // namespace softform
