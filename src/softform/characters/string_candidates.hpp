#pragma once

#include "softform/characters/strings.hpp"

namespace softform {

/// Strings of which a few are to be chosen: from boundary vertices to points of a ring.
struct StringCandidates {
  struct Site {
    Point<2> place, side;
    std::vector<BoundaryWeight> weights;
  };
  struct Line {
    std::size_t site;
    double angle;
  };

  Ring ring;
  std::vector<Site> sites;
  std::vector<Line> lines;

  int count() const { return static_cast<int>(lines.size()); }
  const Site& site_of(int j) const { return sites[lines[static_cast<std::size_t>(j)].site]; }
  double angle_of(int j) const { return lines[static_cast<std::size_t>(j)].angle; }
  /// Direction of candidate j at the positions x (2n).
  Point<2> direction(int j, ConstVec x) const;
  /// Those chosen, with their tensions by pose.
  StringLayout layout(const std::vector<int>& chosen, std::vector<Vec> tensions) const;
};

struct StringCandidateOptions {
  int ring_points = 30;  ///< candidates end at as many points of the ring
  /// A candidate leaves the body at rest within the angle of this cosine from the boundary's normal.
  double least_cosine = 0.35;
};

/// All strings from free boundary vertices that cross the body neither at rest nor in one of the targets.
StringCandidates string_candidates(const PosedBody& posed, const Ring& ring,
                                   const StringCandidateOptions& options = {});

}  // namespace softform
