#pragma once

#include <functional>
#include <string>
#include <vector>

#include "softform/mesh/simplex_mesh.hpp"

namespace softform {

/// A meshed body with its target poses.
template <int dim>
struct PosedBody {
  SimplexMesh<dim> rest;
  std::vector<std::string> names;  ///< of the poses
  std::vector<Vec> targets;        ///< (dim n) each [m]
};

/// Positions (dim n) [m] on the way from rest, 0, to a target, 1.
using BodyWay = std::function<Vec(double fraction)>;

/// The way on which every element turns evenly and stretches evenly (as-rigid-as-possible interpolation; Alexa,
/// Cohen-Or and Levin 2000): with F = R S at the target, at t the positions that come closest to R^t ((1 - t) I + t S)
/// in the mean square over the volume, their mean on a straight line. Turns by more than half a circle are followed from
/// element to element, so that a bar may curl. Precondition: no element of the target is turned over.
template <int dim>
BodyWay rigid_way(const SimplexMesh<dim>& rest, const Vec& target);

/// A target of the whole body from one of its surface: the vertices of the boundary are held at `surface` (3n; others
/// are ignored), the others take the equilibrium of a rubber in between. The result may have elements that are turned
/// over: that is for the caller to refuse.
Vec filled_target(const SimplexMesh<3>& rest, const Vec& surface);

/// Throws InputError, naming the pose and the first of them, when a target has another size than the body or turns
/// elements over. `name` is what the user knows the poses by.
template <int dim>
void require_upright(const PosedBody<dim>& body, const std::string& name);

}  // namespace softform
