#pragma once

#include "softform/equilibrium/newton.hpp"
#include "softform/equilibrium/potential.hpp"
#include "softform/fem/enclosed_volume.hpp"
#include "softform/fem/membrane.hpp"

namespace softform {

/// A rubber membrane with a given rest shape, closed or clamped (see EnclosedVolume): W(x, X) and V(x). It refers to a
/// Membrane that must outlive it.
class PressurizedMembrane {
 public:
  /// rest_positions: (3n) [m].
  PressurizedMembrane(const Membrane& membrane, const Vec& rest_positions);

  const Membrane& membrane() const { return membrane_; }
  const EnclosedVolume& volume() const { return volume_; }
  const Vec& rest_positions() const { return rest_positions_; }
  void set_rest_positions(const Vec& rest_positions);

  double rest_volume() const { return rest_volume_; }
  /// The rest shape's extent [m].
  double rest_size() const { return rest_size_; }
  /// The force of a pressure p on a vertex of mean area at positions x [N].
  double nodal_pressure_force(ConstVec x, double pressure) const;

 private:
  const Membrane& membrane_;
  EnclosedVolume volume_;
  Vec rest_positions_;
  double rest_volume_ = 0;
  double rest_size_ = 0;
};

/// The potential W(x, X) - p V(x) of a membrane under a prescribed pressure (4.7).
class PressurePotential : public Potential {
 public:
  PressurePotential(const PressurizedMembrane& balloon, double pressure, ConstVec x_reference)
      : balloon_(balloon), pressure_(pressure), force_scale_(balloon.nodal_pressure_force(x_reference, pressure))
  {}

  double value(ConstVec x) const override;
  void gradient(ConstVec x, Vec& g) const override;
  void hessian(ConstVec x, SparseMatrix& K) const override;
  double force_scale() const override { return force_scale_; }
  double length_scale() const override { return balloon_.rest_size(); }

 private:
  const PressurizedMembrane& balloon_;
  double pressure_;
  double force_scale_;
  mutable Vec volume_gradient_;
};

/// Equilibrium at a prescribed pressure [Pa] from x0, a minimum of W - p V. Snaps through where the branch ends.
Equilibrium solve_at_pressure(const PressurizedMembrane& balloon, double pressure, const Vec& x0,
                              SparseFactorization& factorization, const NewtonOptions& options = {},
                              const FixedDofs& fixed = {});

}  // namespace softform
