#pragma once

#include <optional>
#include <vector>

#include "softform/equilibrium/potential.hpp"
#include "softform/mesh/triangle_mesh.hpp"

namespace softform {

/// Where a balloon is blown up, chosen on its target.
struct NozzlePlacement {
  /// The nozzle's centre is the vertex that lies farthest this way, and close to the axis through the centroid: any
  /// length. Downwards unless told otherwise.
  Vec3 direction = -Vec3::UnitZ();
  std::optional<int> vertex = std::nullopt;  ///< its centre, instead of a direction
  double diameter = 12e-3;                   ///< [m]
};

/// A disc of vertices that neither inflation nor design moves (thesis 4.4.2): a tube is fixed to them.
struct Nozzle {
  int centre = 0;             ///< the vertex in its middle
  std::vector<int> vertices;  ///< of the disc, sorted
  Vec3 position, axis;        ///< of the centre [m]; outward, of length 1
  double radius = 0;          ///< [m]
};

/// The vertices around the chosen one that are no farther from it than the nozzle's radius.
/// Throws InputError when the placement is none, or the vertices are no disc around the chosen one: too few, too many.
Nozzle place_nozzle(const TriangleMesh& target, const NozzlePlacement& placement);

/// The coordinates of the nozzle's vertices, held.
FixedDofs held_by(const Nozzle& nozzle, int vertex_count);

/// The surface's vertices that are within `distance` [m] of a vertex and connected with it by such vertices; sorted.
std::vector<int> vertices_around(const TriangleMesh& mesh, int vertex, double distance);

}  // namespace softform
