// Material layouts: derivatives of the reduced problem by convergence slope, crisp layouts that are true equilibria,
// refused moves that are counted, and poses that are, or are not, reached from rest.

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "softform/characters/bar_character.hpp"
#include "softform/characters/pose_error.hpp"
#include "softform/inverse/material_program.hpp"
#include "softform/materials/registry.hpp"
#include "softform/optimizers/registry.hpp"
#include "support/deformations.hpp"
#include "support/expect_input_error.hpp"
#include "support/finite_differences.hpp"
#include "support/solids.hpp"

namespace softform::testing {
namespace {

constexpr double size = 0.02;  // [m]

std::shared_ptr<const SolidMaterial> sheet(double mu)
{
  return plane_stress(make_material("neo_hookean", {{"mu", mu}}));
}

// A square held on its left that should stretch and shear, by a dead load at its right; two poses.
class SmallDesign : public ::testing::Test {
 protected:
  SmallDesign()
      : mesh(uneven_block<2>(size, 3)),
        body(mesh.elements, mesh.positions, Mixture(sheet(1e5), sheet(5e6), MixturePath::Geometric)),
        rho(Vec::LinSpaced(body.element_count(), 0.2, 0.8))
  {}

  std::vector<MaterialPose<2>> poses() const
  {
    MaterialPose<2> pose{mesh.positions, mesh.positions, {Vec::Ones(mesh.positions.size())}, {}, {}, {}};
    pose.dead_loads = Vec::Zero(mesh.positions.size());
    for (int i = 0; i < mesh.vertex_count(); ++i) {
      const Point<2> X = mesh.positions.segment<2>(2 * i);
      if (X.x() < 1e-9) pose.fixed.free.segment<2>(2 * i).setZero();
      if (X.x() > size - 1e-9) pose.dead_loads.segment<2>(2 * i) << 100, 60;
      pose.target.segment<2>(2 * i) << 1.1 * X.x(), X.y() + 0.1 * X.x();
    }
    MaterialPose<2> other = pose;
    other.dead_loads *= -0.5;
    return {pose, other};
  }

  double f(const Vec& densities) const
  {
    const MaterialDesign<2> design(body, poses());
    return design.objective(design.start(densities).value(), weights);
  }

  SimplexMesh<2> mesh;
  Solid<2> body;
  Vec rho;
  MaterialWeights weights{0.3, 0.2, 0.1, 1e-3, 0};
};

TEST_F(SmallDesign, GradientAndPrediction)
{
  MaterialDesign<2> design(body, poses());
  const MaterialDesign<2>::State state = design.start(rho).value();
  ASSERT_TRUE(design.linearize(state, weights));
  Vec g;
  design.gradient(g);
  const Vec d = wiggle(static_cast<int>(rho.size()), 3);
  EXPECT_SLOPE(
      check_slope([&](const Vec& r) { return Vec::Constant(1, f(r)); }, rho, d, Vec::Constant(1, g.dot(d)), 0.02));
  const std::vector<Vec> dx = design.predict(d).x;
  EXPECT_SLOPE(check_slope([&](const Vec& r) { return design.start(r).value().x[1]; }, rho, d, dx[1], 0.02));
  // v . H v is the sum of squares of the predicted displacements: 2 of them for f has no half.
  Vec Hd;
  design.distance_product(d, Hd);
  const auto boundary = boundary_vertices<2>(mesh.elements);
  double sum = 0;
  for (const Vec& u : dx)
    for (const int i : boundary) sum += u.segment<2>(2 * i).squaredNorm() / double(boundary.size()) / double(dx.size());
  EXPECT_NEAR(d.dot(Hd) / (2 * sum / 1e-6), 1, 1e-9);
}

// The same problem through the optimiser interface: two methods that share nothing but the programme agree.
TEST_F(SmallDesign, TwoOptimisersAgree)
{
  MaterialDesign<2> design(body, poses());
  const auto program = material_program<2>(design, design.start(rho).value(), {0, 0.2, 0.1, 1e-3, 0});
  Vec g;
  program->objective_gradient(rho, g);
  const Vec d = wiggle(static_cast<int>(rho.size()), 5);
  EXPECT_SLOPE(check_slope([&](const Vec& r) { return Vec::Constant(1, program->objective(r)); }, rho, d,
                           Vec::Constant(1, g.dot(d)), 0.02));
  StopCriteria stop;
  stop.max_iterations = 500;
  stop.relative_decrease = 1e-9;
  const Solution mma = make_optimizer("nlopt_mma")->minimize(*program, stop);
  const Solution lbfgs = make_optimizer("nlopt_lbfgs")->minimize(*program, stop);
  EXPECT_LT(mma.objective, program->objective(rho) - 0.05);
  EXPECT_NEAR(lbfgs.objective / mma.objective, 1, 1e-3);
}

TEST_F(SmallDesign, MovesThatLeaveTheBranchAreRefusedAndCounted)
{
  EquilibriumLimits limits;
  limits.largest_displacement = 1e-5;
  const MaterialDesign<2> design(body, poses(), limits);
  const auto state = design.start(rho).value();
  EXPECT_TRUE(design.move(state, rho).has_value());
  EXPECT_FALSE(design.move(state, Vec::Zero(rho.size())).has_value());
  EXPECT_EQ(design.refused_moves(), 1);
}

TEST_F(SmallDesign, PosesThatDoNotFitAreNamed)
{
  std::vector<MaterialPose<2>> bad = poses();
  bad[1].target.conservativeResize(4);
  test::expect_input_error([&] { MaterialDesign<2>(body, bad); }, {"pose 1", "vertices"});
  bad = poses();
  for (Eigen::Index i = 0; i < bad[0].target.size(); i += 2) bad[0].target[i] *= -1;
  test::expect_input_error([&] { MaterialDesign<2>(body, bad); }, {"pose 0", "element 0"});
}

BarOptions small_bar()
{
  BarOptions options;
  options.cells = {24, 4, 1};
  return options;
}

TEST(MaterialLayout, IsCrispAndAnEquilibriumAndBetterThanUniform)
{
  const BarCharacter bar(small_bar(), question_marks()[3].bends);
  const PoseTrace uniform = bar.trace(Vec::Constant(bar.body().element_count(), 0.5));
  ASSERT_TRUE(uniform.is_reached);
  const MaterialLayout<3> layout = bar.optimize(uniform.x);
  ASSERT_TRUE(layout.report.converged()) << layout.report.message;
  const Vec& rho = layout.state.rho;
  for (Eigen::Index e = 0; e < rho.size(); ++e) EXPECT_TRUE(rho[e] == 0 || rho[e] == 1) << e;
  EXPECT_GT(rho.mean(), 0.01);
  EXPECT_LT(rho.mean(), 0.99);
  const Vec& x = layout.state.x[0];
  EXPECT_LT(3 * pose_error<3>(x, bar.pose(1)).mean, pose_error<3>(uniform.x, bar.pose(1)).mean);
  // The caps are where they belong, and the forces balance on the rest.
  EXPECT_EQ((1 - bar.caps().free.array()).matrix().cwiseProduct(x - bar.pose(1)).lpNorm<Eigen::Infinity>(), 0);
  const LoadedSolid<3> potential(bar.body(), rho);
  Vec g;
  potential.gradient(x, g);
  bar.caps().project(g);
  EXPECT_LT(largest_nodal_norm(g), 1e-7 * potential.force_scale());
}

// What is left grey would take as long again to decide.
TEST(MaterialLayout, DecidesNothingMoreOnceItIsStopped)
{
  const BarCharacter bar(small_bar(), question_marks()[3].bends);
  const PoseTrace uniform = bar.trace(Vec::Constant(bar.body().element_count(), 0.5));
  ASSERT_TRUE(uniform.is_reached);
  int seen = 0;
  const MaterialLayout<3> layout = bar.optimize(uniform.x, [&](const LayoutProgress&) { return ++seen < 3; });
  EXPECT_EQ(layout.report.termination, Termination::Interrupted);
  EXPECT_EQ(seen, 3);
  EXPECT_EQ(layout.trace.size(), 3U);
  const Vec& rho = layout.state.rho;
  EXPECT_GT((rho.array() * (1 - rho.array())).maxCoeff(), 0.1);
}

// A clamped column whose ends are pressed together, and turned by `angle` against each other.
class Column : public ::testing::Test {
 protected:
  Vec place(double strain, double angle) const
  {
    Vec x = mesh.positions;
    for (int i = 0; i < mesh.vertex_count(); ++i) {
      auto p = x.segment<3>(3 * i);
      const bool is_near = p.x() < 0.04;
      const Eigen::Vector2d centre(is_near ? 0 : 0.08, 0.002), arm = p.head<2>() - centre;
      const double a = is_near ? angle : -angle;
      p.head<2>() << centre.x() * (1 - strain) + std::cos(a) * arm.x() - std::sin(a) * arm.y(),
          centre.y() + std::sin(a) * arm.x() + std::cos(a) * arm.y();
    }
    return x;
  }

  PoseTrace trace(const ClampPath<3>& path) const
  {
    return trace_pose<3>(LoadedSolid<3>(body, Vec::Zero(body.element_count())), caps, path);
  }

  static double smallest(const PoseTrace& trace)
  {
    double least = 1;
    for (const TraceStep& step : trace.steps) least = std::min(least, step.relative_eigenvalue);
    return least;
  }

  SimplexMesh<3> mesh = grid<3>({0.08, 0.004, 0.006}, {24, 3, 3});
  Solid<3> body{mesh.elements, mesh.positions, Mixture(neo_hookean_solid(2e5, bulk_modulus(2e5, 0.3)))};
  FixedDofs caps = end_caps(mesh, 0.001);
  // Euler's strain of a column clamped at both ends.
  double critical = 4 * M_PI * M_PI / 12 * std::pow(0.004 / 0.08, 2);
};

TEST_F(Column, PressingBringsTheSmallestEigenvalueToZero)
{
  const PoseTrace half = trace([&](double t) { return place(0.5 * critical * t, 0); });
  EXPECT_TRUE(half.is_reached);
  // It falls in proportion to the strain; linear tetrahedra lock, so that their column buckles later than Euler's.
  const double locked = 0.5 * critical / (1 - smallest(half));
  EXPECT_GT(locked, 0.9 * critical);
  EXPECT_LT(locked, 4 * critical);
  const PoseTrace quarter = trace([&](double t) { return place(0.25 * critical * t, 0); });
  EXPECT_NEAR(1 - smallest(quarter), 0.25 * critical / locked, 0.02);
  const PoseTrace beyond = trace([&](double t) { return place(1.5 * locked * t, 0); });
  EXPECT_TRUE(!beyond.is_reached || smallest(beyond) < 0.15) << smallest(beyond);
}

// An arch whose ends are turned over comes through with a snap.
TEST_F(Column, ASnapIsSaid)
{
  const double angle = 0.7;
  const PoseTrace arch = trace([&](double t) { return place(5 * critical * t, angle * t); });
  EXPECT_TRUE(arch.is_reached);
  const PoseTrace turned = trace([&](double t) {
    return t < 0.5 ? place(10 * critical * t, 2 * angle * t) : place(5 * critical, angle * (3 - 4 * t));
  });
  EXPECT_FALSE(turned.is_reached);
  EXPECT_GT(turned.snapped_at, 0.6);
  // The tangent says so beforehand.
  EXPECT_LT(turned.steps.back().relative_eigenvalue, 0.1);
}

TEST(BentBar, KeepsItsLengthAndTurnsItsEnd)
{
  const BarCharacter bar(small_bar(), question_marks()[1].bends);
  const Positions X = unflatten(bar.mesh().positions), x = unflatten(bar.pose(1));
  // The edge of the near end's face has turned by the sum of the bends, the far end's has not moved.
  EXPECT_NEAR(bar.turn(), 175 * M_PI / 180, 1e-12);
  const auto direction = [&](double along) {
    int low = -1, high = -1;
    for (int i = 0; i < X.rows(); ++i) {
      if (std::abs(X(i, 0) - along) > 1e-9 || X(i, 2) > 1e-9) continue;
      if (X(i, 1) < 1e-9) low = i;
      if (X(i, 1) > 0.004 - 1e-9) high = i;
    }
    return Eigen::RowVector3d(x.row(high) - x.row(low));
  };
  const Eigen::RowVector3d near = direction(0), far = direction(0.08);
  EXPECT_NEAR(far.x(), 0, 1e-12);
  EXPECT_NEAR(near.dot(far) / (near.norm() * far.norm()), std::cos(bar.turn()), 1e-4);
  EXPECT_LT((unflatten(bar.pose(0)) - X).lpNorm<Eigen::Infinity>(), 1e-12);
}

TEST(BentBar, BadInputIsNamed)
{
  BarOptions caps = small_bar();
  caps.cap_cells = 12;
  test::expect_input_error([&] { BarCharacter(caps, {}); }, {"caps of 12 cells"});
  BarOptions contrast = small_bar();
  contrast.contrast = 0.5;
  test::expect_input_error([&] { BarCharacter(contrast, {}); }, {"0.5 times", "exchange"});
  test::expect_input_error([&] { BarCharacter(small_bar(), {{0.07, 0.09, 1}}); }, {"bend from 0.07"});
}

}  // namespace
}  // namespace softform::testing
