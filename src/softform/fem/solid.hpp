#pragma once

#include <vector>

#include "softform/core/types.hpp"
#include "softform/fem/block_pattern.hpp"
#include "softform/fem/solid_element.hpp"
#include "softform/materials/mixture.hpp"
#include "softform/mesh/simplex_mesh.hpp"

namespace softform {

/// Which second derivatives are wanted: the true ones, or those of every element cut to positive semi-definite.
enum class Projection { None, PositiveDefinite };

template <int dim>
struct SolidOptions {
  double thickness = 1;  ///< of a planar body [m]; not used in space
  Eigen::Matrix<double, dim, 1> gravity = Eigen::Matrix<double, dim, 1>::Zero();  ///< [m/s^2]
};

/// The energy of a body of two materials (5.16) in its own weight, with linear triangles in plane stress (dim = 2) or
/// linear tetrahedra (dim = 3):
///     W(x, rho) = sum_e V_e psi(F_e, rho_e) - sum_e m_e(rho_e) g . (mean of the corners of e),
/// a pure function of the positions x (dim n) [m] and the elements' densities rho (m) in [0, 1]; masses are lumped to
/// the vertices. Scratch memory is the only state, so that one object serves one thread.
template <int dim>
class Solid {
 public:
  static constexpr int dimension = dim;

  /// rest_positions: (dim n) [m]. Throws InputError naming an element that is degenerate or turned over.
  Solid(Simplices<dim> elements, Vec rest_positions, Mixture mixture, const SolidOptions<dim>& options = {});

  const Simplices<dim>& elements() const { return elements_; }
  const Vec& rest_positions() const { return rest_positions_; }
  const Mixture& mixture() const { return mixture_; }
  /// Rest volumes of the elements (m) [m^3].
  const Vec& volumes() const { return volumes_; }
  int element_count() const { return static_cast<int>(elements_.rows()); }
  int vertex_count() const { return static_cast<int>(rest_positions_.size()) / dim; }
  const VertexBlockPattern<dim>& pattern() const { return pattern_; }

  /// F of element e.
  Gradient<dim> deformation_gradient(ConstVec x, int e) const;

  /// W [J]; +infinity where the material has no energy.
  double value(ConstVec x, ConstVec rho) const;
  /// dW/dx (dim n) [N].
  void gradient(ConstVec x, ConstVec rho, Vec& g) const;
  /// d2W/dx2 (dim n, dim n) [N/m].
  void hessian(ConstVec x, ConstVec rho, Projection projection, SparseMatrix& K) const;
  /// d2W/dx drho (dim n, m) [N].
  void mixed_hessian(ConstVec x, ConstVec rho, SparseMatrix& B) const;
  /// The Hessian of lambda . dW/dx for lambda (dim n): its blocks (x, x), (x, rho) and the diagonal (rho, rho) (m).
  void force_hessian(ConstVec x, ConstVec rho, ConstVec lambda, SparseMatrix& xx, SparseMatrix& mixed,
                     Vec& rho_rho) const;

 private:
  static constexpr int corners = dim + 1;
  using Point = Eigen::Matrix<double, dim, 1>;
  using Corners = Eigen::Matrix<double, dim, corners>;

  void make_elements();
  void make_mixed_pattern();
  Corners gather(ConstVec x, int e) const;
  Point weight_per_corner(int e, double mass_density) const;
  void set_blocks(int e, const GradientHessian<dim>& H) const;
  void set_mixed_column(int e, const Corners& forces, SparseMatrix& B) const;
  Corners corner_forces(int e, const Gradient<dim>& P) const;
  void prepare_mixed(SparseMatrix& B) const;

  Simplices<dim> elements_;
  Vec rest_positions_;
  Mixture mixture_;
  SolidOptions<dim> options_;
  Vec volumes_;
  std::vector<Eigen::Matrix<double, corners, dim>> shape_gradients_;  // of each corner, by rows [1/m]
  VertexBlockPattern<dim> pattern_;
  SparseMatrix mixed_zero_;
  std::vector<int> corner_rank_;  // place of each corner in its element's column of the mixed pattern
  mutable std::vector<double> element_scalars_, element_vectors_;
  mutable std::vector<typename VertexBlockPattern<dim>::Block> element_blocks_;
};

using PlanarSolid = Solid<2>;
using SpatialSolid = Solid<3>;

}  // namespace softform
