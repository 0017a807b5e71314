#pragma once

#include <map>
#include <string>
#include <vector>

#include "softform/mesh/planar_mesh.hpp"

namespace softform {

/// A flexible bone: a chain of short rigid links along a path.
struct Bone {
  std::string name;
  PlanarPositions joints;  ///< (k + 1, 2) ends of its k links, from the root outwards [m]
  int parent = -1;         ///< index of the bone that it grows from, smaller than its own; -1 for the first
  int parent_link = -1;    ///< the link of the parent that carries it
};

/// How far a bone bends [rad], counter-clockwise: entry i is spread evenly over the i-th of equal parts of its length.
using Bends = std::vector<double>;

/// A pose: bends by the name of a bone; bones without an entry keep their shape.
using SkeletonPose = std::map<std::string, Bends>;

struct Skeleton {
  std::vector<Bone> bones;
};

/// What moves with which link of a skeleton: weights (n, links) of the vertices, non-negative, rows that sum to one.
/// By bone heat (Baran and Popović 2007): -Lap w + H w = H p, where p is 1 on the vertices nearest to the link and
/// H = 1/d^2 with the distance d to it; solved with the cotangent Laplacian, so that heat flows through the mesh and
/// not across gaps.
Eigen::MatrixXd link_weights(const Skeleton& skeleton, const PlanarMesh& mesh);

/// Positions (n, 2) of the mesh's vertices in a pose, by linear blending of the links' rigid motions.
/// Throws InputError when the pose names a bone that is not there.
PlanarPositions posed(const Skeleton& skeleton, const PlanarMesh& mesh, const Eigen::MatrixXd& weights,
                      const SkeletonPose& pose);

}  // namespace softform
