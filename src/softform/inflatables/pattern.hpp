#pragma once

#include <string>
#include <vector>

#include "softform/inflatables/panel_layout.hpp"

namespace softform {

/// What the lines of a pattern mean. Every format keeps them apart.
enum class PatternLayer { Sheet, Cut, Seam, Notches, Labels, Grain };

/// How a layer is drawn.
struct LayerStyle {
  PatternLayer layer;
  const char* name;
  const char* color;  ///< "#rrggbb"
  int color_index;    ///< the closest of AutoCAD's colours
  double width;       ///< [m]
  double dash;        ///< [m], 0 for a full line
};
const std::vector<LayerStyle>& layer_styles();
const LayerStyle& style_of(PatternLayer layer);

struct PatternLine {
  PatternLayer layer;
  FlatPositions points;  ///< [m]
  bool is_closed;
};

struct PatternText {
  PatternLayer layer;
  Eigen::Vector2d center;  ///< [m]
  double angle;            ///< of the writing direction [rad]
  double height;           ///< of capitals [m]
  std::string text;
};

/// What is drawn of a panel, or of a sheet of panels.
struct PatternPiece {
  std::string name;
  std::vector<PatternLine> lines;
  std::vector<PatternText> texts;

  /// The closed line to cut along. Precondition: there is one.
  const FlatPositions& cut() const;
};

/// The piece turned about the origin, then moved; texts that would be upside down are turned by half.
[[nodiscard]] PatternPiece moved(PatternPiece piece, double angle, const Eigen::Vector2d& offset);

struct PieceOptions {
  double allowance = 8e-3;       ///< of material outside the seam line [m]
  double notch_spacing = 50e-3;  ///< about the distance between notches along a seam [m]
  double text_height = 5e-3;     ///< at most [m]
};

/// One piece a panel, in its flat coordinates: the seam line, the line to cut at the allowance around it, notches and
/// the seam's number at the same places on all sides of every seam (the notch closest to its start is double), the
/// panel's number and name, and the grain along the panel's first axis.
/// Throws InputError when the allowance is not positive, or naming the panel that overlaps itself when flat.
std::vector<PatternPiece> pattern_pieces(const PanelLayout& layout, const PieceOptions& options = {});

/// The outline of all that is within `width` [m] of a polygon, corners mitred up to twice the width. A gap of the
/// polygon narrower than two widths closes. Throws InputError when width <= 0 or the polygon crosses itself.
FlatPositions widened(const FlatPositions& polygon, double width);

/// seam,name,left,right,left_length [mm],right_length [mm],mismatch [mm],relative_mismatch: a line for every pair of
/// sides of every seam, numbered as on the pieces; a wall is compared with the left side.
std::string seam_table(const PanelLayout& layout);

}  // namespace softform
