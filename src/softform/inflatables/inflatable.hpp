#pragma once

#include <memory>
#include <vector>

#include "softform/equilibrium/newton.hpp"
#include "softform/fem/enclosed_volume.hpp"
#include "softform/fem/membrane.hpp"
#include "softform/inflatables/panel_layout.hpp"

namespace softform {

/// Panels sewn together, under pressure: the total energy E(x, X) = W(x, X) - p V(x) of the nodes x (3n) and the flat
/// panel vertices X (2v) [m], a pure function, with all derivatives that pattern optimisation (6.16) asks for. The
/// equilibria (6.15) are its stationary points in x. Skins carry the pressure, walls are elastic only. One object
/// serves one thread.
class Inflatable {
 public:
  /// The layout gives triangles, nodes and walls; its flat positions are only a design to start from (see flat()).
  /// Material: a TensionField, or any other for the full energy. thickness [m], pressure [Pa].
  /// Throws InputError unless thickness and pressure are positive and the skins close.
  Inflatable(const PanelLayout& layout, std::shared_ptr<const Material> material, double thickness, double pressure);

  const PanelMembrane& membrane() const { return membrane_; }
  const EnclosedVolume& volume() const { return volume_; }
  double pressure() const { return pressure_; }
  int node_count() const { return membrane_.vertex_count(); }
  /// The pressure on a node of mean area [N] and the extent of the structure [m], both of the layout's nodes.
  double force_scale() const { return force_scale_; }
  double length_scale() const { return length_scale_; }

  /// E [J].
  double value(ConstVec x, ConstVec flat) const;
  /// dE/dx (3n) [N], the negative of the total nodal forces f in (6.15).
  void gradient(ConstVec x, ConstVec flat, Vec& g) const;
  /// dE/dX (2v) [N].
  void rest_gradient(ConstVec x, ConstVec flat, Vec& g) const { membrane_.rest_gradient(x, flat, g); }
  /// d2E/dx2 (3n, 3n) [N/m].
  void hessian(ConstVec x, ConstVec flat, SparseMatrix& K) const;
  /// d2E/dx dX (3n, 2v) [N/m].
  void mixed_hessian(ConstVec x, ConstVec flat, SparseMatrix& B) const { membrane_.mixed_hessian(x, flat, B); }
  /// The Hessian of lambda . dE/dx for lambda (3n): the third derivatives of E contracted once, in the blocks (x, x),
  /// (x, X) and (X, X).
  void force_hessian(ConstVec x, ConstVec flat, ConstVec lambda, SparseMatrix& xx, SparseMatrix& mixed,
                     SparseMatrix& XX) const;

  /// The part of every triangle's width that is lost in wrinkles (m): 1 - s_2 / w, where w is the width that the
  /// unwrinkled material would have by itself, 1/sqrt(s_1) under tension and 1 where it is slack; s_1, s_2 are the
  /// principal stretches. Zero where the membrane is taut.
  Vec compression(ConstVec x, ConstVec flat) const;
  /// The same of patches of triangles, from the mean of their deformation gradients over the rest area: wrinkles that a
  /// fine mesh resolves count as compression. patch: of every triangle (m), negative for none. All triangles of a patch
  /// lie in one panel.
  Vec patch_compression(ConstVec x, ConstVec flat, const std::vector<int>& patch, int patch_count) const;

 private:
  PanelMembrane membrane_;
  EnclosedVolume volume_;
  double pressure_, force_scale_, length_scale_;
  mutable Vec volume_gradient_;
};

/// The layout's flat positions as the vector X (2v).
Vec flat_vector(const PanelLayout& layout);

/// Settings of the static solve that suit nearly inextensible panels: they travel far before they are taut.
NewtonOptions inflation_options();

/// The static solve: a stable equilibrium (6.15) of the panels `flat` from the nodes x0. A shape flat as a sheet needs
/// a small bulge to start from.
///
/// Stiff panels make the energy a narrow valley that Newton's method follows in short steps. From afar, where x0 does
/// not even balance the pressure in the mean, it is therefore first solved loosely under an overpressure that strains
/// the panels by several per cent, and then under less, down to the pressure itself. The trace shows all stages, each
/// with the energy and the residual of its own pressure.
Equilibrium inflate(const Inflatable& inflatable, const Vec& flat, const Vec& x0, SparseFactorization& factorization,
                    const NewtonOptions& options = inflation_options());

/// The same by Newton's method from x0 directly: for a change of an equilibrium, or to keep the folds of x0.
Equilibrium settle(const Inflatable& inflatable, const Vec& flat, const Vec& x0, SparseFactorization& factorization,
                   const NewtonOptions& options = inflation_options());

}  // namespace softform
