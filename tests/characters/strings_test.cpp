// Strings on planar bodies: exact derivatives of the placement programme, tensions that never push, and equilibria
// against independent solutions.

#include <gtest/gtest.h>

#include "softform/characters/string_selection.hpp"
#include "softform/materials/registry.hpp"
#include "softform/mesh/planar_mesh.hpp"
#include "support/deformations.hpp"
#include "support/expect_input_error.hpp"
#include "support/finite_differences.hpp"

namespace softform::testing {
namespace {

Vec number(double value) { return Vec::Constant(1, value); }

PlanarSolid soft_body(const SimplexMesh<2>& mesh)
{
  SolidOptions<2> options;
  options.thickness = 0.01;
  const Mixture rubber(plane_stress(make_material("neo_hookean", {{"mu", 1.6e5}})));
  return PlanarSolid(mesh.elements, mesh.positions, rubber, options);
}

// A soft bar of 60 x 12 mm, 10 mm thick, its left end at the origin and clamped, in a ring.
struct StringBar : ::testing::Test {
  SimplexMesh<2> mesh = grid<2>({0.06, 0.012}, {10, 2});
  PlanarSolid body = soft_body(mesh);
  BoundaryField field{body};
  Vec densities = Vec::Zero(body.element_count());
  FixedDofs held = clamped_end();
  Ring ring{{0.03, 0.006}, 0.08};

  FixedDofs clamped_end() const
  {
    FixedDofs fixed{Vec::Ones(mesh.positions.size())};
    for (int i = 0; i < mesh.vertex_count(); ++i)
      if (mesh.positions[2 * i] < 1e-9) fixed.free.segment<2>(2 * i).setZero();
    return fixed;
  }

  // The bar bent into a circle's arc by `angle`, lengths along its axis kept.
  Vec bent(double angle) const
  {
    Vec x = mesh.positions;
    for (int i = 0; i < mesh.vertex_count(); ++i) {
      const double s = mesh.positions[2 * i] / 0.06 * angle,
                   radius = 0.06 / angle - (mesh.positions[2 * i + 1] - 0.006);
      x.segment<2>(2 * i) << radius * std::sin(s), 0.006 + 0.06 / angle - radius * std::cos(s);
    }
    return x;
  }

  // One string on each long side.
  StringLayout two_strings() const
  {
    return {ring, {{0.0402, 0.0121}, {0.0509, -0.0001}}, {{0, 1}, {0, -1}}, {1.2, -0.9}, {Vec2(0.8, 0.3), Vec2(0.1, 0.9)}};
  }
  static Vec Vec2(double a, double b) { return Eigen::Vector2d(a, b); }
};

TEST_F(StringBar, placement_has_exact_derivatives)
{
  StringPlacementWeights weights;
  weights.sliding.repulsion = 0.3;
  weights.direction = 7;
  StringLayout close = two_strings();
  close.places[1] = {0.0452, 0.0119};  // within the reach of the repulsion
  close.sides[1] = {0, 1};
  close.angles[1] = 1.0;
  for (const StringLayout& strings : {two_strings(), close}) {
    const StringPlacementProgram program(body, densities, held, {bent(0.6), bent(-0.4)}, strings,
                                         {bent(0.5), bent(-0.3)}, weights);
    const Vec z = program.initial_point() + 0.02 * wiggle(program.variable_count(), 7),
              direction = 0.1 * wiggle(program.variable_count(), 3);
    Vec g;
    SparseMatrix J;
    program.objective_gradient(z, g);
    program.constraint_jacobian(z, J);
    EXPECT_SLOPE(check_slope([&](const Vec& y) { return number(program.objective(y)); }, z, direction,
                             number(g.dot(direction)), 1e-1, 1e-3));
    const auto constraints = [&](const Vec& y) {
      Vec c;
      program.constraints(y, c);
      return c;
    };
    EXPECT_SLOPE(check_slope(constraints, z, direction, J * direction, 1e-1, 1e-3));
  }
}

}  // namespace
}  // namespace softform::testing
