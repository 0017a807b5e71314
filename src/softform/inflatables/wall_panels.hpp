#pragma once

#include "softform/inflatables/panel_layout.hpp"
#include "softform/inflatables/seam_curve.hpp"

namespace softform {

/// Adds the plan's walls to a layout: each is stretched out between two of its seams, as the strip of triangles with
/// the shortest rungs; that strip can be laid flat without stretch, and is meshed there with edges of about
/// `edge_length`. Where the seams share no end the wall has a free edge. The segments' seams in the layout get a
/// further side. Precondition: layout.seams are the network's segments. Throws InputError naming the wall whose seams
/// are closed, meet in their middle, or whose strip overlaps itself when flat.
void add_walls(PanelLayout& layout, const SeamNetwork& network, const SeamPlan& plan, double edge_length);

}  // namespace softform
