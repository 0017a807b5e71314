#pragma once

#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "progress.hpp"
#include "softform/inflatables/nesting.hpp"
#include "softform/inflatables/panel_layout.hpp"
#include "softform/inflatables/pattern.hpp"

namespace softform::cli {

/// What panels and inflatable ask for alike.
struct PanelsInput {
  std::string mesh, seams, out;
  std::string flattening = "symmetric-dirichlet", sheet = "600x400mm";
  std::optional<double> size, allowance, notches;
  int vertices = 0;
  bool keeps_grain = false;
};

/// The keys of a seam file, for the help.
extern const char* const seam_file_help;

void add_panels_input(CLI::App& command, PanelsInput& input);

/// How panels are drawn and laid on sheets.
struct SheetSettings {
  PieceOptions pieces;
  NestingOptions nesting;
};

/// Throws InputError naming the option.
SheetSettings sheet_settings(const PanelsInput& input);

/// Throws InputError naming a panel that fits on no sheet; quicker than to lay them all out.
void require_fit(const PanelLayout& layout, const SheetSettings& settings);

std::vector<PatternPiece> laid_on_sheets(const PanelLayout& layout, const SheetSettings& settings);

/// A target and its panels, cut and flattened, in metres.
struct CutTarget {
  TriangleMesh target;
  PanelLayout layout;
};

/// Throws InputError with what is wrong with the target, the seams or the options.
CutTarget cut_target(const PanelsInput& input, Progress& progress);

}  // namespace softform::cli
