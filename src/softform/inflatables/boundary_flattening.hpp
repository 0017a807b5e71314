#pragma once

#include "softform/inflatables/panel_layout.hpp"
#include "softform/optimizers/least_squares_program.hpp"

namespace softform {

/// What the boundary of a panel measures on the target: counter-clockwise, edge j from vertex j to j + 1.
struct BoundaryShape {
  Vec lengths;  ///< (b) of the edges [m]
  Vec angles;   ///< (b) sums of the triangles' angles at the vertices [rad]
};

/// Of a boundary loop of vertices of the mesh.
BoundaryShape boundary_shape(const TriangleMesh& mesh, const std::vector<int>& loop);

/// The flat boundary of a panel after (6.22): a polygon q (b, 2) in which lengths and inner angles are close to those
/// on the target,
///   min  sum_j 1/l_j (l_j(q) - l_j)^2 + m_j (theta_j(q) - theta_j)^2,
/// where m_j is the mean length of the two edges at vertex j. Half of it, as a least-squares programme in x0 y0 x1 ...
class BoundaryFlattening : public LeastSquaresProgram {
 public:
  explicit BoundaryFlattening(BoundaryShape shape);

  std::string name() const override { return "boundary flattening (6.22)"; }
  int variable_count() const override { return static_cast<int>(2 * shape_.lengths.size()); }
  int residual_count() const override { return static_cast<int>(2 * shape_.lengths.size()); }
  /// The edges laid out one after the other, their turns scaled to add up to a full one and the gap spread evenly.
  Vec initial_point() const override;
  void residuals(ConstVec z, Vec& r) const override;
  void residual_jacobian(ConstVec z, SparseMatrix& R) const override;

 private:
  BoundaryShape shape_;
  Vec mean_lengths_;
};

/// The minimiser of (6.22), as (b, 2).
FlatPositions flat_boundary(const BoundaryShape& shape);

}  // namespace softform
