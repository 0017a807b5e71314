#pragma once

#include <vector>

#include "softform/balloons/nozzle.hpp"
#include "softform/mesh/rbf_implicit.hpp"
#include "softform/optimizers/least_squares_program.hpp"

namespace softform {

struct NozzleSmoothingOptions {
  /// Of the distance to the surface in (4.16), squared, against that to the centroid of the neighbours: large enough to
  /// keep vertices on the surface to a few thousandths of an edge.
  double surface_weight = 100;
  /// Vertices that may move, in nozzle radii around its centre on the rest shape; those beyond lie well already.
  double reach = 3;
  /// Steps in which the nozzle's vertices go from the downscaled target to their places.
  int steps = 5;
};

/// The constrained smoothing of the rest shape's mesh, (4.16) and (4.17) as sums of squares,
///     E_s = 1/2 sum_i |X_i - mean of its neighbours|^2 / l^2  +  w/2 sum_i s(X_i)^2 / l^2,
/// l the mean edge length, s the implicit surface. Variables are the positions of the free vertices in units of l; the
/// others are held. The first sum is over all vertices with a free one among them and their neighbours.
class NozzleSmoothing : public LeastSquaresProgram {
 public:
  /// `free`: the vertices that move, sorted. `surface` outlives this object.
  NozzleSmoothing(TriangleMesh mesh, std::vector<int> free, const RbfImplicit& surface, double surface_weight);

  std::string name() const override { return "nozzle smoothing"; }
  int variable_count() const override { return 3 * static_cast<int>(free_.size()); }
  int residual_count() const override { return 3 * static_cast<int>(rings_.size()) + static_cast<int>(free_.size()); }
  Vec initial_point() const override;
  void residuals(ConstVec z, Vec& r) const override;
  void residual_jacobian(ConstVec z, SparseMatrix& R) const override;

  /// The whole mesh, with the free vertices where z says.
  TriangleMesh mesh_at(ConstVec z) const;

 private:
  struct Ring {
    int vertex;
    std::vector<int> neighbours;
  };

  TriangleMesh mesh_;
  std::vector<int> free_;
  std::vector<int> variable_of_;  // of every vertex; -1 where it is held
  std::vector<Ring> rings_;
  const RbfImplicit& surface_;
  double unit_, root_weight_;
};

/// The first rest shape: the target scaled by `scale` about the nozzle's centre, in which the nozzle's vertices stay
/// where they are on the target, and those around it make room, on the scaled surface (4.16).
/// Throws InputError when the nozzle does not fit there: triangles flip or cut each other.
TriangleMesh rest_shape_with_nozzle(const TriangleMesh& target, const Nozzle& nozzle, double scale,
                                    const NozzleSmoothingOptions& options = {});

}  // namespace softform
