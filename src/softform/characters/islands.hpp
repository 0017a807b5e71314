#pragma once

#include <string>
#include <vector>

#include "softform/mesh/simplex_mesh.hpp"

namespace softform {

enum class CharacterMaterial { Soft, Stiff };

/// A connected region of one material: a part to be made. Of a planar body, lengths are those in its plane.
struct Island {
  CharacterMaterial material;
  std::vector<int> elements;
  double volume = 0;                                       ///< [m^3]; of a planar body its area [m^2]
  Vec3 centre = Vec3::Zero(), lower_corner, upper_corner;  ///< centroid and bounding box [m]
  /// Diameter of the largest ball (circle) inside [m], from below: among those around the inner points that are tried,
  /// the centres of the elements' own balls, and the vertices.
  double inscribed_diameter = 0;
  /// Parts that would be left beside the first if everything narrower than the printable size broke away, by the
  /// elements' incentres and the middles of their faces: about so many necks are too thin.
  int necks = 0;

  bool is_printable(double size) const { return inscribed_diameter >= size; }
};

/// The islands of a layout, largest first: elements of one material that hang together by faces (edges in the plane).
/// densities: (m), below 1/2 soft. `printable_size` [m] decides what a neck is.
template <int dim>
std::vector<Island> find_islands(const SimplexMesh<dim>& mesh, const Vec& densities, double printable_size);

/// One line an island for people and programs, in mm: number, material, elements, area or volume, place, extent,
/// inscribed diameter, necks, and what is to be said of it.
template <int dim>
std::string island_table(const std::vector<Island>& islands, double printable_size);

}  // namespace softform
