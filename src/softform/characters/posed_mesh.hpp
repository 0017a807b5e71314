#pragma once

#include <functional>
#include <string>
#include <vector>

#include "softform/equilibrium/potential.hpp"
#include "softform/mesh/simplex_mesh.hpp"

namespace softform {

/// Positions (dim n) [m] of a body's vertices at a fraction of the way from rest (0) to a pose (1).
using PoseWay = std::function<Vec(std::size_t pose, double fraction)>;

/// A meshed body with its target poses.
template <int dim>
struct PosedMesh {
  SimplexMesh<dim> rest;
  FixedDofs held;                  ///< at rest in every pose; no coordinates when nothing is held
  std::vector<std::string> names;  ///< of the poses
  std::vector<Vec> targets;        ///< (dim n) each [m]
  PoseWay way;
};

/// Ways on which every element turns evenly and stretches evenly (as-rigid-as-possible interpolation; Alexa,
/// Cohen-Or and Levin 2000): with F = R S at the target, at t the positions that come closest to R^t ((1 - t) I + t S)
/// in the mean square over the volume, their mean on a straight line. Turns by more than half a circle are followed
/// from element to element, so that a bar may curl. Precondition: no element of a target is turned over.
template <int dim>
PoseWay rigid_way(const SimplexMesh<dim>& rest, const std::vector<Vec>& targets);

/// A target of the whole body from one of its surface: the vertices of the boundary are held at `surface` (3n; others
/// are ignored), the others take the equilibrium of a rubber in between. The result may have elements that are turned
/// over: that is for the caller to refuse.
Vec filled_target(const SimplexMesh<3>& rest, const Vec& surface);

/// Throws InputError, naming the pose and the first of them, when a target has another size than the body or turns
/// elements over. `name` is what the user knows the poses by.
template <int dim>
void require_upright(const PosedMesh<dim>& body, const std::string& name);

}  // namespace softform
