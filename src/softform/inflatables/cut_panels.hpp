#pragma once

#include "softform/inflatables/panel_layout.hpp"
#include "softform/inflatables/seam_curve.hpp"

namespace softform {

/// The panels between the seams of a plan, named, each a disc, and its walls; they lie on the target and are not yet
/// flat. `mesh` is the target's mesh at the size wanted of the result (see remesh_to_vertex_count), `target` the exact
/// surface. Throws InputError naming the seam, panel and place when seams do not meet as they should (see lay_seams), a
/// panel has a hole or a handle (with the seam that would cure it), or a panel's name has no panel of its own.
PanelLayout cut_into_panels(const TriangleMesh& mesh, const Geodesics& target, const SeamPlan& plan);

}  // namespace softform
