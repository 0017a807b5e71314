#pragma once

#include <array>

#include "softform/inflatables/panel_layout.hpp"
#include "softform/optimizers/nonlinear_program.hpp"

namespace softform {

/// Flattens a disc with little stretch, without folds (Smith and Schaefer 2015), and keeps the lengths of its boundary:
///   f = 1/A sum_t A_t (|F_t|^2 + |F_t^-1|^2)  +  w / sqrt(A) sum_j (l_j(q) - l_j)^2 / l_j,
/// where F_t takes triangle t of area A_t from its own plane on the target to the plane, A is the area of all, and l_j
/// are the boundary's edges. Dimensionless, 4 for an isometry, +infinity where a triangle is turned over.
/// Variables are x0 y0 x1 ... of the mesh's vertices.
class SymmetricDirichlet : public NonlinearProgram {
 public:
  /// `start` (n, 2) without folds, see tutte_disc(). Precondition: the mesh is a disc bounded by `loop`.
  SymmetricDirichlet(const TriangleMesh& mesh, const std::vector<int>& loop, double length_weight, FlatPositions start);

  std::string name() const override { return "symmetric Dirichlet energy"; }
  int variable_count() const override { return static_cast<int>(start_.size()); }
  int constraint_count() const override { return 0; }
  Vec initial_point() const override;
  double objective(ConstVec z) const override;
  void objective_gradient(ConstVec z, Vec& g) const override;
  /// The exact Hessian with the triangles' negative eigenvalues set to zero.
  void gauss_newton_hessian(ConstVec z, SparseMatrix& H) const override;
  bool lagrangian_hessian(ConstVec z, ConstVec, SparseMatrix& H) const override;
  void constraints(ConstVec, Vec& c) const override { c.resize(0); }
  void constraint_jacobian(ConstVec, SparseMatrix& J) const override { J.resize(0, variable_count()); }

 private:
  /// Gradients (3, 2) of a triangle's shape functions in its own plane, and its share of the area.
  struct Element {
    std::array<int, 3> vertices;
    Eigen::Matrix<double, 3, 2> gradients;
    double weight;
  };
  struct BoundaryEdge {
    int start, end;
    double length, weight;
  };
  enum class Projection { None, SemiDefinite };
  Eigen::Matrix2d deformation(const Element& element, ConstVec z) const;
  void assemble(ConstVec z, Projection projection, SparseMatrix& H) const;

  std::vector<Element> elements_;
  std::vector<BoundaryEdge> boundary_;
  FlatPositions start_;
  SparseMatrix pattern_;
};

/// Tutte's embedding: the boundary loop on a circle by its lengths, counter-clockwise, around the disc's area, every
/// other vertex in the middle of its neighbours. (n, 2), free of folds.
FlatPositions tutte_disc(const TriangleMesh& mesh, const std::vector<int>& loop);

/// The vertices off the loop placed in the middle of their neighbours (the Tutte Laplacian of (6.21) is zero) for given
/// places (b, 2) of the loop's. (n, 2).
FlatPositions tutte_interior(const TriangleMesh& mesh, const std::vector<int>& loop, const FlatPositions& boundary);

}  // namespace softform
