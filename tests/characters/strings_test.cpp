// Strings on planar bodies: exact derivatives of the placement programme, tensions that never push, and equilibria
// against independent solutions.

#include <gtest/gtest.h>

#include "softform/characters/reachability.hpp"
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
  PosedBody posed{body, densities, held, {bent(0.6), bent(-0.4)}};

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

  static Vec Vec2(double a, double b) { return Eigen::Vector2d(a, b); }

  // One string on each long side.
  StringLayout two_strings() const
  {
    return {
        ring, {{0.0402, 0.0121}, {0.0509, -0.0001}}, {{0, 1}, {0, -1}}, {1.2, -0.9}, {Vec2(0.5, 0.1), Vec2(0.1, 0.4)}};
  }
};

TEST_F(StringBar, placement_has_exact_derivatives)
{
  StringPlacementWeights weights;
  weights.sliding.repulsion = 0.3;
  weights.direction = 7;
  weights.tension = 2;
  StringLayout close = two_strings();
  close.places[1] = {0.0452, 0.0119};  // within the reach of the repulsion
  close.sides[1] = {0, 1};
  close.angles[1] = 1.0;
  for (const StringLayout& strings : {two_strings(), close}) {
    const StringPlacementProgram program(posed, strings, {bent(0.5), bent(-0.3)}, weights);
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

TEST_F(StringBar, interpolated_normals_have_exact_derivatives)
{
  const BoundaryNormals normals(body);
  const Point<2> place(0.0312, 0.0121), side(0, 1);
  const std::vector<int> kernels = field.kernels(place, side, 2 * field.radius());
  const Vec x = bent(0.5) + 2e-4 * wiggle(static_cast<int>(mesh.positions.size()), 7),
            direction = 1e-3 * wiggle(static_cast<int>(x.size()), 3);
  const InterpolatedNormal at = normals.interpolated(field.weights(place, kernels), x);
  EXPECT_NEAR(at.value.norm(), 1, 1e-14);
  Point<2> slope = Point<2>::Zero();
  for (const auto& [vertex, by_position] : at.by_positions) slope += by_position * direction.segment<2>(2 * vertex);
  EXPECT_SLOPE(
      check_slope([&](const Vec& y) { return Vec(normals.interpolated(field.weights(place, kernels), y).value); }, x,
                  direction, slope, 1e-1, 1e-6));
  const Vec along = 1e-3 * Vec2(0.8, 0.3);
  EXPECT_SLOPE(check_slope([&](const Vec& l) { return Vec(normals.interpolated(field.weights(l, kernels), x).value); },
                           place, along, at.by_place * along, 1e-1, 1e-6));
}

// A list of edges that went out of scope once left vertices of this mesh without neighbours.
TEST_F(StringBar, normals_at_rest_are_those_of_the_straight_sides)
{
  const BoundaryNormals normals(body);
  for (const Point<2>& side : {Point<2>(0, 1), Point<2>(0, -1)}) {
    const Point<2> place(0.03, side.y() > 0 ? 0.012 : 0);
    const std::vector<int> kernels = field.kernels(place, side, field.radius());
    EXPECT_LT((normals.interpolated(field.weights(place, kernels), mesh.positions).value - side).norm(), 1e-12);
  }
}

// A strip that is free to thin, drawn along its axis: tension = w t G (lambda - 1/lambda^2) for neo-Hookean rubber in
// plane stress.
TEST_F(StringBar, a_string_stretches_a_strip_by_the_closed_form)
{
  constexpr double width = 0.012, thickness = 0.01, G = 1.6e5, stretch = 1.3;
  FixedDofs rollers{Vec::Ones(mesh.positions.size())};
  String<2> string{{}, {0.2, 0}, width * thickness * G * (stretch - 1 / (stretch * stretch))};
  for (int i = 0; i < mesh.vertex_count(); ++i) {
    const Point<2> X = mesh.positions.segment<2>(2 * i);
    if (X.x() < 1e-9) rollers.free[2 * i] = 0;
    if (X.x() < 1e-9 && X.y() < 1e-9) rollers.free[2 * i + 1] = 0;
    if (X.x() < 0.06 - 1e-9) continue;
    string.point.vertices.push_back(i);
    string.point.weights.push_back(std::abs(X.y() - 0.006) < 1e-9 ? 0.5 : 0.25);
  }
  string.anchor.y() = 0.006 / std::sqrt(stretch);  // where the axis comes to lie
  SparseFactorization factorization;
  const Equilibrium found =
      solve_equilibrium(LoadedSolid<2>(body, densities, {}, {}, {string}), mesh.positions, factorization, {}, rollers);
  ASSERT_TRUE(found.report.converged()) << found.report.message;
  for (int i = 0; i < mesh.vertex_count(); ++i) {
    const Point<2> X = mesh.positions.segment<2>(2 * i);
    const Point<2> expected(stretch * X.x(), X.y() / std::sqrt(stretch));
    EXPECT_LT((found.x.segment<2>(2 * i) - expected).norm(), 1e-9) << i;
  }
}

// At equilibrium a string is a dead load along its direction: the two potentials have the same stationary point.
TEST_F(StringBar, strings_balance_like_the_dead_loads_that_they_end_as)
{
  const StringLayout strings = two_strings();
  const StringPoses poses = settled(posed, strings, {mesh.positions, mesh.positions});
  EXPECT_EQ(poses.failed_equilibria, 0);
  EXPECT_EQ(poses.negative_eigenvalues, 0);
  const StringPlan plan = string_plan(field, strings, poses.positions);
  for (std::size_t i = 0; i < 2; ++i) {
    Vec loads = Vec::Zero(mesh.positions.size());
    std::size_t j = 0;
    for (const String<2>& line : strings_of_pose(field, strings, i)) {
      Point<2> tied = Point<2>::Zero();
      for (std::size_t k = 0; k < line.point.vertices.size(); ++k)
        tied += line.point.weights[k] * poses.positions[i].segment<2>(2 * line.point.vertices[k]);
      EXPECT_NEAR((line.anchor - tied).norm(), plan.strings[j].free_lengths[i], 1e-12);
      EXPECT_EQ(line.tension, plan.strings[j++].tensions[i]);
      for (std::size_t k = 0; k < line.point.vertices.size(); ++k)
        loads.segment<2>(2 * line.point.vertices[k]) +=
            line.point.weights[k] * line.tension * (line.anchor - tied).normalized();
    }
    SparseFactorization factorization;
    const Equilibrium found =
        solve_equilibrium(LoadedSolid<2>(body, densities, loads), mesh.positions, factorization, {}, held);
    EXPECT_LT((found.x - poses.positions[i]).lpNorm<Eigen::Infinity>(), 1e-9);
    EXPECT_GT((found.x - mesh.positions).lpNorm<Eigen::Infinity>(), 1e-3);
  }
}

// The bar is to bend up in one pose and down in the other: the string on the far side would have to push.
TEST_F(StringBar, no_string_pushes_and_moving_them_brings_the_bar_nearer)
{
  const StringSelection start = select_strings(posed, ring, 2);
  StringPlacementOptions options;
  options.weights.direction = 0.1;  // the distances alone are to decide: the bar is small
  const StringPlacement after = place_strings(posed, start.strings, start.poses.positions, options);
  const auto error = [&](const std::vector<Vec>& x) {
    return (x[0] - posed.targets[0]).squaredNorm() + (x[1] - posed.targets[1]).squaredNorm();
  };
  EXPECT_LT(error(after.poses.positions), 0.5 * error(start.poses.positions));
  EXPECT_EQ(after.poses.failed_equilibria, 0);
  EXPECT_EQ(after.poses.negative_eigenvalues, 0);
  EXPECT_LT(after.poses.residual, 1e-6);
  const int up = after.strings.sides[0].y() > 0 ? 0 : 1;
  for (const auto& [pose, drawn] : {std::pair{0, up}, std::pair{1, 1 - up}}) {
    const Vec& tensions = after.strings.tensions[static_cast<std::size_t>(pose)];
    EXPECT_GT(tensions[drawn], 0.1);
    EXPECT_EQ(tensions[1 - drawn], 0);  // at its bound exactly
    // The bound is active for a reason: a little tension takes the bar away from its target.
    StringLayout tightened = after.strings;
    tightened.tensions[static_cast<std::size_t>(pose)][1 - drawn] = 0.02;
    EXPECT_GT(error(settled(posed, tightened, after.poses.positions).positions), error(after.poses.positions));
  }
}

TEST_F(StringBar, placement_that_is_stopped_leaves_equilibria)
{
  const StringSelection start = select_strings(posed, ring, 2);
  int steps = 0;
  const StringPlacement placement =
      place_strings(posed, start.strings, start.poses.positions, {}, [&](const Iterate&) { return ++steps < 2; });
  EXPECT_EQ(steps, 2);
  EXPECT_EQ(placement.poses.failed_equilibria, 0);
  EXPECT_LT(placement.poses.residual, 1e-6);
}

TEST_F(StringBar, two_strings_are_selected_on_opposite_sides)
{
  const StringSelection selection = select_strings(posed, ring, 2);
  ASSERT_EQ(selection.strings.count(), 2);
  EXPECT_LT(selection.strings.sides[0].y() * selection.strings.sides[1].y(), 0);
  for (const Vec& tensions : selection.strings.tensions) EXPECT_GE(tensions.minCoeff(), 0);
  EXPECT_EQ(selection.poses.failed_equilibria, 0);
  EXPECT_EQ(selection.poses.negative_eigenvalues, 0);
  for (std::size_t i = 0; i < 2; ++i)
    EXPECT_LT((selection.poses.positions[i] - posed.targets[i]).norm(),
              0.3 * (mesh.positions - posed.targets[i]).norm());
}

TEST_F(StringBar, refuses_more_strings_than_there_are_candidates)
{
  test::expect_input_error([&] { select_strings(posed, ring, 100000); }, {"100000 strings cannot be had"});
}

TEST_F(StringBar, is_reached_from_rest_by_drawing_the_strings)
{
  const StringLayout strings = two_strings();
  const auto loads = [&](double share) {
    std::vector<String<2>> lines = strings_of_pose(field, strings, 0);
    for (String<2>& line : lines) line.tension *= share;
    return LoadedSolid<2>(body, densities, {}, {}, lines);
  };
  const PoseTrace trace = trace_pose<2>(LoadPath<2>(loads), held, [&](double) { return mesh.positions; });
  EXPECT_TRUE(trace.is_reached);
  const StringPoses poses = settled(posed, strings, {mesh.positions, mesh.positions});
  EXPECT_LT((trace.x - poses.positions[0]).lpNorm<Eigen::Infinity>(), 1e-8);
}

TEST(LengthInside, is_that_of_the_stretches_in_the_body)
{
  const SimplexMesh<2> square = grid<2>({1, 1}, {2, 2});
  const auto edges = boundary_faces<2>(square.elements).faces;
  const auto inside = [&](double x0, double y0, double x1, double y1) {
    return length_inside(edges, square.positions, {x0, y0}, {x1, y1});
  };
  EXPECT_NEAR(inside(-1, 0.3, 2, 0.3), 1, 1e-12);             // through
  EXPECT_NEAR(inside(0.4, 0.3, 2, 0.3), 0.6, 1e-12);          // from within
  EXPECT_NEAR(inside(1.001, 0.3, 2, 0.3), 0, 1e-12);          // away from its side
  EXPECT_NEAR(inside(-0.001, 0.3, 2, 0.3), 1, 1e-12);         // from the other side
  EXPECT_NEAR(inside(0.7, -0.1, 1.2, 0.4), 0.2828427, 1e-6);  // across a corner
}

}  // namespace
}  // namespace softform::testing
