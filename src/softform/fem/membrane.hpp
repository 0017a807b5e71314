#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "softform/core/types.hpp"
#include "softform/fem/block_pattern.hpp"
#include "softform/fem/membrane_element.hpp"
#include "softform/materials/material.hpp"

namespace softform {

/// The elastic energy of a membrane (3.36), W(x, X) = sum_e h_e A_e Psi(C_e), a pure function of the deformed positions
/// x (3n) and the rest positions X (k N) [m], where k is the `rest_dimension`: 3 for a rubber skin, 2 for flat panels.
/// A vertex on a seam of panels has a rest position in each of them, so that N >= n; every triangle knows its vertices
/// in both shapes. Scratch memory is the only state, so that one object serves one thread; the element loops use every
/// core themselves.
template <int rest_dimension>
class MembraneOf {
 public:
  /// A membrane with the same vertices in both shapes, k = 3.
  /// thickness: one value per triangle (m) [m]. Throws InputError where it is not positive.
  MembraneOf(const Triangles& triangles, int vertex_count, std::shared_ptr<const Material> material, Vec thickness)
      : MembraneOf(triangles, vertex_count, triangles, vertex_count, std::move(material), std::move(thickness))
  {}
  /// rest_triangles (m, 3): the vertices of each triangle among the rest positions.
  MembraneOf(Triangles triangles, int vertex_count, Triangles rest_triangles, int rest_vertex_count,
             std::shared_ptr<const Material> material, Vec thickness);

  const Triangles& triangles() const { return triangles_; }
  int vertex_count() const { return vertex_count_; }
  const Triangles& rest_triangles() const { return rest_triangles_; }
  int rest_vertex_count() const { return rest_vertex_count_; }
  const Material& material() const { return *material_; }
  const Vec& thickness() const { return thickness_; }
  /// The pattern of matrices of the deformed positions (3n, 3n).
  const BlockPattern& pattern() const { return pattern_; }

  /// W [J]; +infinity where an element is degenerate or overflows.
  double value(ConstVec x, ConstVec rest_positions) const;
  /// dW/dx (3n) [N]; the membrane forces (3.20) are its negative.
  void gradient(ConstVec x, ConstVec rest_positions, Vec& g) const;
  /// dW/dX (k N) [N].
  void rest_gradient(ConstVec x, ConstVec rest_positions, Vec& g) const;
  /// d2W/dx2 (3n, 3n) [N/m], the true Hessian.
  void hessian(ConstVec x, ConstVec rest_positions, SparseMatrix& K) const;
  /// A positive semi-definite model of the Hessian: the moduli without negative eigenvalues, and the geometric
  /// stiffness of the stresses that pull. Returns false, and leaves K alone, where nothing is compressed.
  bool projected_hessian(ConstVec x, ConstVec rest_positions, SparseMatrix& K) const;
  /// d2W/dx dX (3n, k N) [N/m]: rows are deformed, columns rest coordinates.
  void mixed_hessian(ConstVec x, ConstVec rest_positions, SparseMatrix& B) const;
  /// The Hessian of lambda . dW/dx, the membrane's part in that of a Lagrangian, for lambda (3n): the third derivatives
  /// of W contracted once. Its blocks are those of (x, x), (x, X) and (X, X).
  void force_hessian(ConstVec x, ConstVec rest_positions, ConstVec lambda, SparseMatrix& xx, SparseMatrix& mixed,
                     SparseMatrix& XX) const;
  /// d2W/dx d(parameter) (3n) [N per unit of the parameter], for a parameter of the material by its place.
  void parameter_gradient(ConstVec x, ConstVec rest_positions, int parameter, Vec& g) const;
  /// The spatially averaged extension ratio (4.8), the square root of the ratio of deformed to rest area.
  double mean_stretch(ConstVec x, ConstVec rest_positions) const;
  /// The principal stretches of every triangle (m, 2), the larger first: square roots of the eigenvalues of C~.
  Eigen::MatrixX2d principal_stretches(ConstVec x, ConstVec rest_positions) const;

 private:
  template <class Evaluate>
  void assemble_gradient(ConstVec x, const Evaluate& evaluate, Vec& g) const;

  TriangleEdges deformed_edges(ConstVec x, int t) const;
  EdgesOf<rest_dimension> rest_edges(ConstVec rest_positions, int t) const;

  Triangles triangles_;
  int vertex_count_;
  Triangles rest_triangles_;
  int rest_vertex_count_;
  std::shared_ptr<const Material> material_;
  Vec thickness_;
  BlockPattern pattern_;
  VertexBlockPattern<3, rest_dimension> mixed_pattern_;
  VertexBlockPattern<rest_dimension, rest_dimension> rest_pattern_;
  mutable std::vector<double> element_scalars_, element_vectors_;
  mutable std::vector<Eigen::Matrix3d> element_blocks_;
};

using Membrane = MembraneOf<3>;
using PanelMembrane = MembraneOf<2>;

}  // namespace softform
