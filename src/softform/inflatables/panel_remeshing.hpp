#pragma once

#include <optional>

#include "softform/inflatables/panel_layout.hpp"
#include "softform/mesh/distance.hpp"

namespace softform {

struct PanelRemeshingOptions {
  /// Flat triangles below this quality call for new ones: an equilateral triangle has 1, one that is squeezed to a
  /// sixth of its height 0.3, and optimisers stall on what is much worse.
  double quality_threshold = 0.2;
  /// Wanted length of the edges [m]; 0 for about as many triangles as before.
  double edge_length = 0;
};

/// Whether a flat triangle is worse than the threshold. A panel's tip of an angle a has a quality of sqrt(3) sin a /
/// (2 - cos a) at most: below 7 degrees new triangles are no cure.
bool needs_remeshing(const PanelLayout& layout, const PanelRemeshingOptions& options = {});

/// A layout whose panels were triangulated anew, and the state of its nodes.
struct RemeshedPanels {
  PanelLayout layout;
  Vec x;  ///< (3n) inflated positions of its nodes [m]
};

/// New triangles for all panels as they are cut now (thesis 6.6.3). Seams are divided into equally long
/// edges, as many on every side and at the same places between the old vertices; their ends stay. Seams that are held
/// on the target (weight > 0) stay as they are unless their edges are much longer or shorter than wanted. Panels are
/// filled by triangulate_inside(). Flat positions, inflated ones x (3n) and places on the target are interpolated, by
/// cubics along boundaries and linearly in the old triangles inside; nodes of the skins are then projected to the
/// target. Names, order and weights of panels and seams stay. Nothing when a panel's boundary crosses or touches
/// itself; triangles that are folded inside do no harm. Precondition: panels are discs.
std::optional<RemeshedPanels> remeshed(const PanelLayout& layout, const Vec& x, const SurfaceDistance& target,
                                       const PanelRemeshingOptions& options = {});

/// Panels that were just cut and flattened, meshed anew with about `count` triangles: seams find their places best on a
/// fine mesh, and designs are found fastest on a coarse one. As they are where they cannot be meshed anew.
PanelLayout with_triangles(const PanelLayout& layout, const SurfaceDistance& target, int count);

}  // namespace softform
