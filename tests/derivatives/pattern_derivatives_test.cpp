// The derivatives of the objectives of pattern optimisation (6.17 to 6.21) and of its programme (6.16).

#include <cmath>

#include <gtest/gtest.h>

#include "softform/inflatables/pattern_design.hpp"
#include "softform/inflatables/seam_lengths.hpp"
#include "softform/materials/tension_field.hpp"
#include "softform/mesh/distance.hpp"
#include "softform/mesh/shapes.hpp"
#include "softform/objectives/sampled_distance.hpp"
#include "support/deformations.hpp"
#include "support/finite_differences.hpp"

namespace softform::testing {
namespace {

VectorFunction gradient_of(const Objective& objective)
{
  return [&objective](const Vec& y) {
    Vec g;
    objective.gradient(y, g);
    return g;
  };
}

void check_derivatives(const Objective& objective, const Vec& x, double step)
{
  const Vec direction = wiggle(static_cast<int>(x.size()), 3);
  const Vec g = gradient_of(objective)(x);
  EXPECT_SLOPE(check_slope([&](const Vec& y) { return Vec::Constant(1, objective.value(y)); }, x, direction,
                           Vec::Constant(1, g.dot(direction)), step));
  SparseMatrix H;
  ASSERT_TRUE(objective.hessian(x, H));
  EXPECT_SLOPE(check_slope(gradient_of(objective), x, direction, H * direction, step));
}

std::shared_ptr<const ImlsField> unit_sphere_field()
{
  return std::make_shared<ImlsField>(imls_field(irregular_sphere(1, 1000), 2000));
}

// Inside, outside, where kernels of one width fade and wider ones take over, and beyond all.
TEST(ImlsField, DerivativesAtEveryDistance)
{
  const auto field = unit_sphere_field();
  for (const double radius : {0.9, 1.02, 1.1, 1.17, 1.2, 1.25, 1.4, 2.0, 0.4, 6.0}) {
    SCOPED_TRACE(radius);
    const Vec x = radius * Vec3(0.3, -0.5, 0.7).normalized();
    const Vec direction = Vec3(0.2, 0.5, -0.4);
    const auto at = [&](const Vec& y) { return field->evaluate(y, ImlsField::Derivatives::Second); };
    const double step = 0.05 * field->radius();
    EXPECT_SLOPE(check_slope([&](const Vec& y) { return Vec::Constant(1, at(y).distance); }, x, direction,
                             Vec::Constant(1, at(x).gradient.dot(direction)), step));
    EXPECT_SLOPE(
        check_slope([&](const Vec& y) -> Vec { return at(y).gradient; }, x, direction, at(x).hessian* direction, step));
  }
}

// Off the true distance by some h^2 / 12 R, and by the choice of the centre far out.
TEST(ImlsField, IsTheSignedDistanceToASphere)
{
  const ImlsField field = imls_field(irregular_sphere(1, 5000), 10'000);
  for (const double radius : {0.3, 0.95, 1.0, 1.05, 3.0}) {
    const double distance = field.evaluate(radius * Vec3(1, 2, -2) / 3, ImlsField::Derivatives::First).distance;
    EXPECT_NEAR(distance, radius - 1, 2e-3) << radius;
  }
}

// A field of one width jumped by a percent where its kernels ended: no step decreased the objective of a shape that
// was that far from its target.
TEST(ImlsField, HasNoEdgeWhereKernelsEnd)
{
  const auto field = unit_sphere_field();
  const Vec3 direction = Vec3(0.3, -0.5, 0.7).normalized();
  const double step = 1e-3;
  for (double radius = 0.5; radius < 2; radius += step) {
    const auto here = field->evaluate(radius * direction, ImlsField::Derivatives::First);
    const auto there = field->evaluate((radius + step) * direction, ImlsField::Derivatives::First);
    const double by_slopes = 0.5 * step * (here.gradient + there.gradient).dot(direction);
    ASSERT_NEAR(there.distance - here.distance, by_slopes, 0.01 * step) << radius;
  }
}

TEST(SampledDistance, Derivatives)
{
  const TriangleMesh mesh = irregular_sphere(1.05, 100);
  const SampledDistance distance(mesh.triangles, 100, Vec::Ones(mesh.triangle_count()), unit_sphere_field(), 2);
  check_derivatives(distance, flatten(mesh.vertices) + 0.02 * wiggle(300, 1), 3e-3);
}

// What a sum over nodes cannot see: all nodes on the target and triangles that cut through it.
TEST(SampledDistance, SeesTrianglesBetweenNodes)
{
  const PanelLayout lunes = three_lune_sphere(1, 2);
  const TriangleMesh coarse{lunes.nodes, node_triangles(lunes)};
  const SampledDistance distance(coarse.triangles, coarse.vertex_count(), Vec::Ones(coarse.triangle_count()),
                                 unit_sphere_field(), 1);
  const Vec at_nodes = SurfaceDistance(irregular_sphere(1, 1000)).distances(coarse.vertices);
  EXPECT_LT(at_nodes.maxCoeff(), 0.01);
  const double root_mean_square = std::sqrt(distance.value(flatten(coarse.vertices)) / coarse.vertex_count());
  EXPECT_GT(root_mean_square, 0.1);
}

TEST(SeamLengths, Derivatives)
{
  const PanelLayout layout = three_lune_sphere(1, 3);
  const Vec flat = flat_vector(layout);
  check_derivatives(SeamLengths(layout, 2), flat + 0.05 * wiggle(static_cast<int>(flat.size()), 1), 1e-2);
}

TEST(SeamLengths, ComparesEdgesNotSides)
{
  PanelLayout layout = three_lune_sphere(1, 3);
  EXPECT_LT(SeamLengths(layout, 1).value(flat_vector(layout)), 1e-20);
  // A vertex of one side moved along it: the sides are as long as before.
  const std::vector<int>& side = layout.seams[0].sides[0].vertices;
  layout.flat.row(side[2]) += 0.1 * (layout.flat.row(side[3]) - layout.flat.row(side[2]));
  EXPECT_GT(SeamLengths(layout, 1).value(flat_vector(layout)), 1e-4);
}

class PatternProgram : public ::testing::Test {
 protected:
  PatternProgram()
  {
    for (Seam& seam : layout.seams) seam.weight = 0.5;
    inflation.material = std::make_shared<TensionField>(5e3, 0.05, 2e-5);
    inflation.thickness = 1e-3;
    inflation.pressure = 1;
    objectives.unit_length = 2;
    objectives.weights.stability = 0;
    program = pattern_program(layout, flatten(layout.nodes), inflation, unit_sphere_field(), objectives);
  }

  // Off equilibrium, and where no residual is zero.
  Vec point() const
  {
    const Vec z = program->initial_point();
    return z + 0.02 * wiggle(static_cast<int>(z.size()), 2);
  }

  PanelLayout layout = three_lune_sphere(1, 3);
  InflationSettings inflation;
  PatternObjectiveSettings objectives;
  std::unique_ptr<FullSpaceProgram> program;
};

TEST_F(PatternProgram, Derivatives)
{
  const Vec z = point(), direction = wiggle(static_cast<int>(z.size()), 5);
  Vec g;
  program->objective_gradient(z, g);
  EXPECT_SLOPE(check_slope([&](const Vec& y) { return Vec::Constant(1, program->objective(y)); }, z, direction,
                           Vec::Constant(1, g.dot(direction)), 1e-3));
  SparseMatrix J;
  program->constraint_jacobian(z, J);
  const auto constraints = [&](const Vec& y) {
    Vec c;
    program->constraints(y, c);
    return c;
  };
  EXPECT_SLOPE(check_slope(constraints, z, direction, J * direction, 1e-4));
}

TEST_F(PatternProgram, LagrangianHessian)
{
  const Vec z = point(), direction = wiggle(static_cast<int>(z.size()), 5);
  const Vec lambda = wiggle(program->constraint_count(), 9);
  SparseMatrix H;
  ASSERT_TRUE(program->lagrangian_hessian(z, lambda, H));
  const auto gradient = [&](const Vec& y) -> Vec {
    Vec g;
    SparseMatrix J;
    program->objective_gradient(y, g);
    program->constraint_jacobian(y, J);
    return g + J.transpose() * lambda;
  };
  EXPECT_SLOPE(check_slope(gradient, z, direction, H * direction, 1e-4));
}

}  // namespace
}  // namespace softform::testing
