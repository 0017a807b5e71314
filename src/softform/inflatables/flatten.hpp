#pragma once

#include <string>

#include "softform/inflatables/panel_layout.hpp"

namespace softform {

enum class FlatteningMethod {
  Boundary,            ///< the boundary by (6.22), the interior by the Tutte Laplacian: as in the thesis
  SymmetricDirichlet,  ///< little stretch everywhere and the boundary's lengths; never folds
};

/// "boundary" or "symmetric-dirichlet". Throws InputError that lists them.
FlatteningMethod flattening_method(const std::string& name);

struct FlatteningOptions {
  FlatteningMethod method = FlatteningMethod::SymmetricDirichlet;
  /// Weight of the boundary's lengths beside the symmetric Dirichlet energy: sides that are sewn together come from one
  /// curve, and lengths that are kept are equal.
  double length_weight = 100;
};

/// The flat shape (n, 2) of a disc in space, counter-clockwise, around the origin, its long axis along the first.
/// Throws InputError when the result folds over itself; `name` is the panel's.
FlatPositions flattened(const TriangleMesh& panel, const std::string& name, const FlatteningOptions& options = {});

/// Flattens all panels of a layout. Precondition: they are discs.
void flatten_panels(PanelLayout& layout, const FlatteningOptions& options = {});

/// How far flat panels are from the target: an isometry has none of it.
struct Distortion {
  double mean = 0, max = 0;  ///< |sigma - 1| over both principal stretches of the triangles, by area; the largest
};
Distortion distortion(const PanelLayout& layout, int panel);

}  // namespace softform
