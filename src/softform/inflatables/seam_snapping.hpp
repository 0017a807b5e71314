#pragma once

#include <vector>

#include "softform/inflatables/panel_layout.hpp"
#include "softform/inflatables/seam_curve.hpp"

namespace softform {

/// A mesh with seams along its edges: one chain a segment of the network.
struct SeamedMesh {
  TriangleMesh mesh;
  std::vector<SeamChain> chains;
};

/// Brings seams into a mesh of the target: each takes the chain of edges that is closest to it, whose vertices then
/// move to equal distances along the seam while the mesh around flips its edges and relaxes on the target. The numbers
/// of vertices and triangles stay. Throws InputError naming seam and place where the mesh has no room for them.
SeamedMesh snap_to_seams(const TriangleMesh& mesh, const Geodesics& target, const SeamNetwork& network,
                         const SeamPlan& plan);

}  // namespace softform
