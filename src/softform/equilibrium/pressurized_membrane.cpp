#include "softform/equilibrium/pressurized_membrane.hpp"

#include <cmath>

#include "softform/mesh/triangle_mesh.hpp"

namespace softform {

PressurizedMembrane::PressurizedMembrane(const Membrane& membrane, const Vec& rest_positions)
    : membrane_(membrane), volume_(membrane.triangles(), membrane.vertex_count())
{
  set_rest_positions(rest_positions);
}

void PressurizedMembrane::set_rest_positions(const Vec& rest_positions)
{
  rest_positions_ = rest_positions;
  rest_volume_ = volume_.value(rest_positions_);
  const Positions positions = unflatten(rest_positions_);
  rest_size_ = (positions.colwise().maxCoeff() - positions.colwise().minCoeff()).norm();
}

double PressurizedMembrane::nodal_pressure_force(ConstVec x, double pressure) const
{
  return std::abs(pressure) * surface_area(x, membrane_.triangles()) / membrane_.vertex_count();
}

double PressurePotential::value(ConstVec x) const
{
  return balloon_.membrane().value(x, balloon_.rest_positions()) - pressure_ * balloon_.volume().value(x);
}

void PressurePotential::gradient(ConstVec x, Vec& g) const
{
  balloon_.membrane().gradient(x, balloon_.rest_positions(), g);
  balloon_.volume().gradient(x, volume_gradient_);
  g -= pressure_ * volume_gradient_;
}

void PressurePotential::hessian(ConstVec x, SparseMatrix& K) const
{
  balloon_.membrane().hessian(x, balloon_.rest_positions(), K);
  balloon_.volume().add_hessian(x, -pressure_, K);
}

Equilibrium solve_at_pressure(const PressurizedMembrane& balloon, double pressure, const Vec& x0,
                              SparseFactorization& factorization, const NewtonOptions& options, const FixedDofs& fixed)
{
  const PressurePotential potential(balloon, pressure, x0);
  Equilibrium equilibrium = solve_equilibrium(potential, x0, factorization, options, fixed);
  equilibrium.pressure = pressure;
  return equilibrium;
}

}  // namespace softform
