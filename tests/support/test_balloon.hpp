#pragma once

#include <memory>
#include <utility>

#include "softform/equilibrium/volume_control.hpp"
#include "softform/materials/registry.hpp"
#include "softform/mesh/triangle_mesh.hpp"

namespace softform::testing {

/// A closed mesh as a balloon of uniform thickness, with all that a solve needs.
struct TestBalloon {
  TestBalloon(TriangleMesh rest_mesh, std::shared_ptr<const Material> material, double thickness = 3e-4)
      : mesh(std::move(rest_mesh)),
        membrane(mesh.triangles, mesh.vertex_count(), std::move(material),
                 Vec::Constant(mesh.triangle_count(), thickness)),
        balloon(membrane, flatten(mesh.vertices))
  {}

  /// Equilibrium at the volume of a uniform stretch, started from a state that was found at another one.
  Equilibrium at_stretch(double stretch, const Equilibrium& start, double start_stretch)
  {
    const double volume = balloon.rest_volume() * stretch * stretch * stretch;
    return solve_at_volume(balloon, volume, stretch / start_stretch * start.x, start.pressure, factorization);
  }
  Equilibrium at_stretch(double stretch)
  {
    Equilibrium start;
    start.x = balloon.rest_positions();
    return at_stretch(stretch, start, 1);
  }

  /// Negative eigenvalues of the tangent under a prescribed pressure.
  int negative_eigenvalues(const Vec& x, double pressure)
  {
    SparseMatrix K;
    PressurePotential(balloon, pressure, x).hessian(x, K);
    return count_negative_eigenvalues(std::move(K), factorization);
  }

  TriangleMesh mesh;
  Membrane membrane;
  PressurizedMembrane balloon;
  SparseFactorization factorization;
};

inline std::shared_ptr<const Material> neo_hookean() { return make_material("neo_hookean", {{"mu", 0.3e6}}); }

/// The silicone of the balloons.
inline std::shared_ptr<const Material> silicone()
{
  return make_material("hart_smith", {{"G", 0.16163e6}, {"k1", 0.0219}, {"k2", 0.2453}});
}

}  // namespace softform::testing
