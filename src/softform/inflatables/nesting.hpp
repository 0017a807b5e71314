#pragma once

#include <vector>

#include "softform/inflatables/pattern.hpp"

namespace softform {

struct NestingOptions {
  double sheet_width = 0.6, sheet_height = 0.4;  ///< [m]
  double gap = 3e-3;                             ///< between pieces, and to the sheet's edge [m]
  /// Pieces may only be turned by half, so that the grain stays along the sheet; else by multiples of 30 degrees.
  bool keeps_grain = false;
};

/// Lays pieces on as few sheets as come easily: the largest first, each on the first sheet and at the place and angle
/// where it ends farthest to the left, without overlap (no-fit polygons, as in Burke et al. 2007). A sheet is a piece
/// with its frame from (0, 0), called "sheet 1" and so on. Throws InputError naming a piece that no empty sheet takes.
std::vector<PatternPiece> nested(const std::vector<PatternPiece>& pieces, const NestingOptions& options);

}  // namespace softform
