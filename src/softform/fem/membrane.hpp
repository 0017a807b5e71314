#pragma once

#include <memory>
#include <vector>

#include "softform/core/types.hpp"
#include "softform/fem/block_pattern.hpp"
#include "softform/materials/material.hpp"

namespace softform {

/// The elastic energy of a rubber membrane (3.36), W(x, X) = sum_e h_e A_e Psi(C_e), a pure function of the deformed
/// positions x (3n) and the rest positions X (3n) [m]. Scratch memory is the only state, so that one object serves one
/// thread; the element loops use every core themselves.
class Membrane {
 public:
  /// thickness: one value per triangle (m) [m]. Throws InputError where it is not positive.
  Membrane(Triangles triangles, int vertex_count, std::shared_ptr<const Material> material, Vec thickness);

  const Triangles& triangles() const { return triangles_; }
  int vertex_count() const { return vertex_count_; }
  const Material& material() const { return *material_; }
  const Vec& thickness() const { return thickness_; }
  /// The pattern of every matrix below.
  const BlockPattern& pattern() const { return pattern_; }

  /// W [J]; +infinity where an element is degenerate or overflows.
  double value(ConstVec x, ConstVec rest_positions) const;
  /// dW/dx (3n) [N]; the membrane forces (3.20) are its negative.
  void gradient(ConstVec x, ConstVec rest_positions, Vec& g) const;
  /// d2W/dx2 (3n, 3n) [N/m], the true Hessian.
  void hessian(ConstVec x, ConstVec rest_positions, SparseMatrix& K) const;
  /// d2W/dx dX (3n, 3n) [N/m]: rows are deformed, columns rest coordinates.
  void mixed_hessian(ConstVec x, ConstVec rest_positions, SparseMatrix& B) const;
  /// The Hessian of lambda . dW/dx, the membrane's part in that of a Lagrangian, for lambda (3n): the third derivatives
  /// of W contracted once. Its blocks (3n, 3n) are those of (x, x), (x, X) and (X, X).
  void force_hessian(ConstVec x, ConstVec rest_positions, ConstVec lambda, SparseMatrix& xx, SparseMatrix& mixed,
                     SparseMatrix& XX) const;
  /// d2W/dx d(parameter) (3n) [N per unit of the parameter], for a parameter of the material by its place.
  void parameter_gradient(ConstVec x, ConstVec rest_positions, int parameter, Vec& g) const;
  /// The spatially averaged extension ratio (4.8), the square root of the ratio of deformed to rest area.
  double mean_stretch(ConstVec x, ConstVec rest_positions) const;

 private:
  template <class Evaluate>
  void assemble_gradient(ConstVec x, const Evaluate& evaluate, Vec& g) const;

  Triangles triangles_;
  int vertex_count_;
  std::shared_ptr<const Material> material_;
  Vec thickness_;
  BlockPattern pattern_;
  mutable std::vector<double> element_scalars_, element_vectors_;
  mutable std::vector<Eigen::Matrix3d> element_blocks_;
};

}  // namespace softform
