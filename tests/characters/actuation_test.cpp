// Stages 1 and 2 of the characters: exact derivatives of their programmes, the boundary's field, and a bar whose
// actuation is known.

#include <gtest/gtest.h>

#include "softform/characters/pin_placement.hpp"
#include "softform/characters/sparse_actuation.hpp"
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

// A soft bar of 60 x 12 mm, 10 mm thick, with its left end at the origin.
struct Bar : ::testing::Test {
  SimplexMesh<2> mesh = grid<2>({0.06, 0.012}, {10, 2});
  PlanarSolid body = soft_body(mesh);
  Vec densities = Vec::Zero(body.element_count());

  // The bar bent into a circle's arc by `angle`, lengths along its axis kept.
  Vec bent(double angle) const
  {
    Vec x = mesh.positions;
    for (int i = 0; i < mesh.vertex_count(); ++i) {
      const double s = mesh.positions[2 * i] / 0.06 * angle,
                   radius = 0.06 / angle - (mesh.positions[2 * i + 1] - 0.006);
      x.segment<2>(2 * i) << radius * std::sin(s), 0.06 / angle - radius * std::cos(s);
    }
    return x;
  }

  void expect_exact_derivatives(const NonlinearProgram& program, const Vec& z, bool has_hessian)
  {
    const Vec direction = 0.1 * wiggle(program.variable_count(), 3);
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
    if (!has_hessian) return;
    const Vec lambda = wiggle(program.constraint_count(), 5);
    SparseMatrix H;
    ASSERT_TRUE(program.lagrangian_hessian(z, lambda, H));
    const auto gradient = [&](const Vec& y) {
      Vec at_y;
      SparseMatrix jacobian;
      program.objective_gradient(y, at_y);
      program.constraint_jacobian(y, jacobian);
      return Vec(at_y + jacobian.transpose() * lambda);
    };
    EXPECT_SLOPE(check_slope(gradient, z, direction, H * direction, 1e-1, 1e-3));
  }
};

TEST_F(Bar, sparse_actuation_has_exact_derivatives)
{
  // The Hessian is exact without the regulariser, whose majoriser stands in for a concave function.
  for (const double weight : {0.0, 3.0}) {
    const SparseActuationProgram program(body, {bent(0.6), bent(-0.4)}, boundary_vertices<2>(mesh.elements),
                                         {weight, 4, 0.1});
    Vec z = program.initial_point();
    z += 0.05 * wiggle(program.variable_count(), 7);
    expect_exact_derivatives(program, z, weight == 0);
  }
}

Pins two_pins(double angle_offset)
{
  return {{{0.0302, 0.0121}, {0.0409, -0.0001}},
          {{0, 1}, {0, -1}},
          {{{0.0312, 0.0151}, {0.0409, 0.0019 + angle_offset}}, {{0.0292, 0.0101}, {0.0399, -0.0011}}}};
}

TEST_F(Bar, pin_placement_has_exact_derivatives)
{
  PinPlacementWeights weights;
  weights.repulsion = 0.3;
  Pins close = two_pins(0);
  close.places[1] = {0.0352, 0.0119};  // within the reach of the repulsion
  close.sides[1] = {0, 1};
  for (const Pins& pins : {two_pins(0), close}) {
    const PinPlacementProgram program(body, densities, {bent(0.6), bent(-0.4)}, pins, {bent(0.5), bent(-0.3)}, weights);
    expect_exact_derivatives(program, program.initial_point() + 0.02 * wiggle(program.variable_count(), 7), false);
  }
}

TEST_F(Bar, boundary_field_is_the_distance_to_a_straight_side)
{
  const BoundaryField field(body);
  const BoundaryField::Place place(0.031, 0.0127), side(0, 1);
  const std::vector<int> kernels = field.kernels(place, side, field.radius());
  BoundaryField::Place gradient;
  EXPECT_NEAR(field.value(place, kernels, &gradient), 0.0007, 1e-12);
  EXPECT_NEAR((gradient - side).norm(), 0, 1e-9);
  double sum = 0;
  for (const BoundaryWeight& weight : field.weights(place, kernels)) {
    EXPECT_NEAR(mesh.positions[2 * weight.vertex + 1], 0.012, 1e-12);  // the other side is not seen
    sum += weight.value;
  }
  EXPECT_NEAR(sum, 1, 1e-12);
  EXPECT_LT((field.projected(place, side) - BoundaryField::Place(0.031, 0.012)).norm(), 1e-12);
}

TEST_F(Bar, fewer_actuators_for_a_larger_weight_in_balance)
{
  const std::vector<Vec> targets{bent(0.8), bent(-0.5)};
  int count = body.vertex_count();
  for (const double weight : {0.1, 1.0, 10.0}) {
    const PointActuation actuation = sparse_actuation(body, targets, weight);
    EXPECT_LE(actuation.count(), count) << weight;
    EXPECT_GE(actuation.count(), 2) << weight;
    EXPECT_LT(actuation.infeasibility, 1e-3) << weight;  // [N], of forces of newtons
    count = actuation.count();
  }
}

TEST_F(Bar, a_range_of_actuators_is_met_and_moving_them_brings_the_bar_nearer)
{
  const std::vector<Vec> targets{bent(0.8), bent(-0.5)};
  const PointActuation actuation = actuation_in_range(body, targets, {3, 4});
  EXPECT_GE(actuation.count(), 3);
  EXPECT_LE(actuation.count(), 4);
  const auto error = [&](const std::vector<Vec>& x) {
    return (x[0] - targets[0]).squaredNorm() + (x[1] - targets[1]).squaredNorm();
  };
  PinPlacementOptions still;
  still.rounds = 0;
  const PinPlacement before =
      place_pins(body, densities, targets, pins_from(body, actuation), actuation.positions, still);
  const PinPlacement after = place_pins(body, densities, targets, before.pins, before.positions);
  EXPECT_LT(error(after.positions), error(before.positions));
  EXPECT_LT(error(after.positions), 1e-2 * error({mesh.positions, mesh.positions}));
  EXPECT_EQ(after.negative_eigenvalues, 0);
  EXPECT_LT(after.residual, 1e-6);
}

TEST_F(Bar, refuses_a_range_that_cannot_be_met)
{
  for (const ActuatorRange range : {ActuatorRange{1, 1}, ActuatorRange{5, 4}, ActuatorRange{3, 1000}})
    test::expect_input_error([&] { actuation_in_range(body, {bent(0.5)}, range); }, {"cannot be had"});
}

}  // namespace
}  // namespace softform::testing
