#pragma once

#include <memory>
#include <vector>

#include "softform/equilibrium/pressurized_membrane.hpp"
#include "softform/mesh/triangle_mesh.hpp"

namespace softform {

/// A flat circular rubber sheet of uniform thickness, clamped at its rim in the plane z = 0 and inflated towards +z:
/// the specimen of thesis 4.3.2. The volume is that between the sheet and the plane of the clamp.
class ClampedSheet {
 public:
  /// radius of the opening and thickness in metres; the mesh is disc(radius, rings).
  ClampedSheet(double radius, double thickness, int rings, std::shared_ptr<const Material> material);

  const TriangleMesh& mesh() const { return mesh_; }
  const Membrane& membrane() const { return *membrane_; }
  const PressurizedMembrane& balloon() const { return *balloon_; }
  const FixedDofs& clamp() const { return clamp_; }
  double radius() const { return radius_; }

  double height(ConstVec x) const { return x[2]; }
  /// The stretch at the pole, the root of the area ratio of the triangles around it.
  double pole_stretch(ConstVec x) const;
  double mean_stretch(ConstVec x) const { return membrane_->mean_stretch(x, balloon_->rest_positions()); }

 private:
  double radius_;
  TriangleMesh mesh_;
  std::shared_ptr<Membrane> membrane_;
  std::shared_ptr<PressurizedMembrane> balloon_;
  FixedDofs clamp_;
};

/// The vertices of disc(radius, rings) moved onto the part of a sphere over the disc that has this volume, spread
/// evenly along its meridians (3n).
Vec spherical_cap(const TriangleMesh& flat_disc, double radius, double volume);

/// The volume under the mesh of a sheet that stands for a smooth one of this volume. Facets inscribed in a dome enclose
/// less than the dome, and the pressure of a shallow sheet goes with the cube of its volume: the ratio is taken from a
/// sphere's cap.
double faceted_volume(const ClampedSheet& sheet, double volume);

/// Equilibria of the sheet at rising volumes [m^3], one after the other from the flat state, with tangent prediction
/// and as many steps in between as it takes. Ends early at the first volume that is not reached; the last state's
/// report then says why.
std::vector<Equilibrium> inflate(const ClampedSheet& sheet, const std::vector<double>& volumes,
                                 SparseFactorization& factorization);

}  // namespace softform
