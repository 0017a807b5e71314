// One inverse problem in two formulations: their derivatives, and that they agree.

#include <algorithm>
#include <limits>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "softform/inverse/rest_shape_design.hpp"
#include "softform/mesh/shapes.hpp"
#include "softform/objectives/edge_dihedral.hpp"
#include "softform/objectives/volume_reward.hpp"
#include "softform/optimizers/reduced_gauss_newton.hpp"
#include "support/deformations.hpp"
#include "support/finite_differences.hpp"
#include "support/test_balloon.hpp"

namespace softform::testing {
namespace {

constexpr double size = 0.03;  // [m]

TriangleMesh ellipsoid(int vertex_count)
{
  TriangleMesh mesh = irregular_sphere(size, vertex_count);
  mesh.vertices.col(0) *= 1.25;
  mesh.vertices.col(2) *= 0.8;
  return mesh;
}

// An ellipsoid to be reached from its copy of half the size, inflated.
class EllipsoidDesign : public ::testing::Test {
 protected:
  EllipsoidDesign()
  {
    const TriangleMesh target = ellipsoid(150);
    const Vec goal = flatten(target.vertices);
    design.membrane = std::make_shared<const Membrane>(target.triangles, target.vertex_count(), silicone(),
                                                       Vec::Constant(target.triangle_count(), 3e-4));
    design.rest_positions0 = 0.5 * goal;
    const PressurizedMembrane balloon(*design.membrane, design.rest_positions0);
    SparseFactorization factorization;
    InflationOptions inflation;
    inflation.newton.tolerance = 1e-11;
    const Equilibrium inflated = inflate_to_volume(balloon, enclosed_volume(target), factorization, inflation);
    EXPECT_TRUE(inflated.report.converged()) << inflated.report.message;
    design.x0 = inflated.x;
    design.pressure = inflated.pressure;
    design.force_scale = inflated.pressure * surface_area(goal, target.triangles) / target.vertex_count();
    // Tight, so that the equilibrium is a smooth function of the design down to the smallest differences.
    design.newton.tolerance = 1e-11;
    design.state_terms = {{1, std::make_shared<EdgeDihedralDistance>(target.triangles, goal)}};
    design.design_terms = {{1e-2, std::make_shared<EdgeDihedralDistance>(target.triangles, design.rest_positions0,
                                                                         EdgeDihedralWeights{0, 1})},
                           {1e-5, std::make_shared<VolumeReward>(target.triangles, design.rest_positions0)}};
  }

  int n() const { return static_cast<int>(design.x0.size()); }

  // A design that differs from the first, where no term has its minimum.
  Vec changed_rest() const { return design.rest_positions0 + 0.01 * size * wiggle(n(), 2); }

  RestShapeDesign design;
};

TEST_F(EllipsoidDesign, FullSpaceDerivatives)
{
  const auto program = full_space_program(design);
  ASSERT_EQ(program->variable_count(), 2 * n());
  ASSERT_EQ(program->constraint_count(), n());
  // Away from equilibrium.
  const Vec z = program->initial_point() + 0.01 * size * wiggle(2 * n(), 3), direction = wiggle(2 * n(), 5);
  Vec g;
  program->objective_gradient(z, g);
  EXPECT_SLOPE(check_slope([&](const Vec& y) { return Vec::Constant(1, program->objective(y)); }, z, direction,
                           Vec::Constant(1, g.dot(direction)), 2e-3 * size));
  SparseMatrix J;
  program->constraint_jacobian(z, J);
  const auto constraints = [&](const Vec& y) {
    Vec c;
    program->constraints(y, c);
    return c;
  };
  EXPECT_SLOPE(check_slope(constraints, z, direction, J * direction, 2e-3 * size));
}

// Derivatives along what is free; along what is held there are none.
TEST_F(EllipsoidDesign, HeldCoordinatesStay)
{
  Vec& free = design.fixed.free;
  free = Vec::Ones(n());
  free.segment(30, 60).setZero();
  const auto program = full_space_program(design), reduced = reduced_program(design);
  Vec both(2 * n());
  both << free, free;
  const Vec z = program->initial_point() + 0.01 * size * both.cwiseProduct(wiggle(2 * n(), 3));
  const Vec direction = both.cwiseProduct(wiggle(2 * n(), 5));
  Vec g;
  SparseMatrix J;
  program->objective_gradient(z, g);
  program->constraint_jacobian(z, J);
  EXPECT_EQ(g.cwiseProduct(Vec::Ones(2 * n()) - both).norm(), 0);
  EXPECT_SLOPE(check_slope([&](const Vec& y) { return Vec::Constant(1, program->objective(y)); }, z, direction,
                           Vec::Constant(1, g.dot(direction)), 2e-3 * size));
  const auto constraints = [&](const Vec& y) {
    Vec c;
    program->constraints(y, c);
    return c;
  };
  EXPECT_SLOPE(check_slope(constraints, z, direction, J * direction, 2e-3 * size));

  const Vec rest = design.rest_positions0 + 0.01 * size * free.cwiseProduct(wiggle(n(), 2));
  reduced->objective_gradient(rest, g);
  EXPECT_SLOPE(check_slope([&](const Vec& y) { return Vec::Constant(1, reduced->objective(y)); }, rest,
                           free.cwiseProduct(wiggle(n(), 7)),
                           Vec::Constant(1, g.dot(free.cwiseProduct(wiggle(n(), 7)))), 1e-3 * size));
  const Solution solution = ReducedGaussNewton().minimize(*program, {.max_iterations = 5});
  EXPECT_LT(solution.objective, program->objective(program->initial_point()));
  EXPECT_EQ((solution.z - program->initial_point()).cwiseProduct(Vec::Ones(2 * n()) - both).norm(), 0);
}

TEST_F(EllipsoidDesign, LagrangianHessianIsExact)
{
  design.design_terms.pop_back();  // the volume's Hessian is dense
  const auto program = full_space_program(design);
  const Vec z = program->initial_point() + 0.01 * size * wiggle(2 * n(), 3);
  const Vec direction = wiggle(2 * n(), 5), lambda = 1e-3 * wiggle(n(), 7);
  const auto gradient = [&](const Vec& y) -> Vec {
    Vec g;
    SparseMatrix J;
    program->objective_gradient(y, g);
    program->constraint_jacobian(y, J);
    return g + J.transpose() * lambda;
  };
  SparseMatrix H;
  ASSERT_TRUE(program->lagrangian_hessian(z, lambda, H));
  EXPECT_SLOPE(check_slope(gradient, z, direction, H * direction, 2e-3 * size));
  EXPECT_LT((SparseMatrix(H.transpose()) - H).norm(), 1e-12 * H.norm());
}

TEST_F(EllipsoidDesign, LagrangianHessianIsRefusedWhereATermHasNone)
{
  SparseMatrix H;
  const auto program = full_space_program(design);
  EXPECT_FALSE(program->lagrangian_hessian(program->initial_point(), Vec::Zero(n()), H));
}

TEST_F(EllipsoidDesign, JacobianAndHessiansKeepTheirPatterns)
{
  const auto program = full_space_program(design);
  const Vec z = program->initial_point();
  SparseMatrix J, H, D;
  for (const double factor : {1.0, 1.01}) {
    program->constraint_jacobian(factor * z, J);
    program->gauss_newton_hessian(factor * z, H);
    program->step_metric(factor * z, D);
    EXPECT_TRUE(J.isCompressed() && H.isCompressed() && D.isCompressed());
  }
  const auto [nonzeros_J, nonzeros_H] = std::pair{J.nonZeros(), H.nonZeros()};
  program->constraint_jacobian(z, J);
  program->gauss_newton_hessian(z, H);
  EXPECT_EQ(J.nonZeros(), nonzeros_J);
  EXPECT_EQ(H.nonZeros(), nonzeros_H);
  // Gauss-Newton: positive semi-definite.
  const Vec eigenvalues = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(Eigen::MatrixXd(H)).eigenvalues();
  EXPECT_GT(eigenvalues.minCoeff(), -1e-9 * eigenvalues.maxCoeff());
}

TEST_F(EllipsoidDesign, RestorationFindsTheEquilibriumAndKeepsTheDesign)
{
  const auto program = full_space_program(design);
  Vec z = program->initial_point(), c;
  z.tail(n()) = changed_rest();
  program->constraints(z, c);
  ASSERT_GT(c.cwiseAbs().maxCoeff(), 1e-3);
  const auto restored = program->restore(z);
  ASSERT_TRUE(restored.has_value());
  program->constraints(*restored, c);
  EXPECT_LT(c.cwiseAbs().maxCoeff(), 1e-8);
  EXPECT_EQ(restored->tail(n()), z.tail(n()));
}

TEST_F(EllipsoidDesign, NoEquilibriumIsSaid)
{
  Vec z(2 * n());
  z << design.x0, design.rest_positions0;
  z[n() + 4] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(full_space_program(design)->restore(z).has_value());
  const auto reduced = reduced_program(design);
  EXPECT_FALSE(std::isfinite(reduced->objective(z.tail(n()))));
  Vec g;
  reduced->objective_gradient(z.tail(n()), g);
  EXPECT_FALSE(g.allFinite());
}

TEST_F(EllipsoidDesign, InadmissibleDesignsAreRefused)
{
  const double widest = 1.001 * design.rest_positions0.maxCoeff();
  const Solution free = ReducedGaussNewton().minimize(*full_space_program(design), {.max_iterations = 10});
  ASSERT_GT(free.z.tail(n()).maxCoeff(), widest);
  design.is_admissible = [widest](ConstVec rest) { return rest.maxCoeff() < widest; };
  Vec z(2 * n());
  z << design.x0, design.rest_positions0;
  EXPECT_TRUE(full_space_program(design)->restore(z).has_value());
  z *= 1.002;
  EXPECT_FALSE(full_space_program(design)->restore(z).has_value());
  EXPECT_EQ(reduced_program(design)->objective(z.tail(n())), std::numeric_limits<double>::infinity());
  const Solution solution = ReducedGaussNewton().minimize(*full_space_program(design), {.max_iterations = 10});
  EXPECT_TRUE(design.is_admissible(solution.z.tail(n())));
}

TEST_F(EllipsoidDesign, AdjointGradientIsTheSlopeOfTheReducedObjective)
{
  const auto program = reduced_program(design);
  const Vec rest = changed_rest(), direction = wiggle(n(), 7);
  Vec g;
  program->objective_gradient(rest, g);
  EXPECT_SLOPE(check_slope([&](const Vec& y) { return Vec::Constant(1, program->objective(y)); }, rest, direction,
                           Vec::Constant(1, g.dot(direction)), 2e-3 * size));
}

// dE/dX - B^t K^-1 dE/dx with the full-space derivatives and dense algebra; K has the six rigid modes for a kernel.
TEST_F(EllipsoidDesign, AdjointGradientIsTheTotalDerivativeOfTheFullSpace)
{
  const auto full = full_space_program(design);
  const auto reduced = reduced_program(design);
  Vec z = full->initial_point();
  z.tail(n()) = changed_rest();
  const auto feasible = full->restore(z);
  ASSERT_TRUE(feasible.has_value());
  EXPECT_NEAR(full->objective(*feasible), reduced->objective(changed_rest()), 1e-10);

  Vec g, reduced_gradient;
  SparseMatrix J;
  full->objective_gradient(*feasible, g);
  full->constraint_jacobian(*feasible, J);
  const Eigen::MatrixXd K = J.leftCols(n()), B = J.rightCols(n());
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver;
  solver.setThreshold(1e-8);
  solver.compute(K);
  EXPECT_EQ(solver.rank(), n() - 6);
  const Vec adjoint = solver.solve(g.head(n()));
  const Vec total = g.tail(n()) - B.transpose() * adjoint;
  reduced->objective_gradient(changed_rest(), reduced_gradient);
  EXPECT_LT((total - reduced_gradient).norm(), 1e-5 * total.norm());
}

// One factorisation for an adjoint, and at least one for an equilibrium: what a method costs in either formulation.
TEST_F(EllipsoidDesign, FactorisationsInsideAreCounted)
{
  const auto program = reduced_program(design);
  Vec g;
  program->objective(changed_rest());
  const int before = program->inner_linear_solves();
  EXPECT_GT(before, 1);
  program->objective_gradient(changed_rest(), g);
  EXPECT_EQ(program->inner_linear_solves(), before + 1);

  const auto full = full_space_program(design);
  const Solution solution = ReducedGaussNewton().minimize(*full, {.max_iterations = 2});
  const Evaluations& count = solution.report.evaluations;
  EXPECT_GE(count.linear_solve, full->inner_linear_solves() + 2);  // and one a step
  EXPECT_EQ(count.linear_solve, solution.report.trace.back().linear_solves);
}

TEST_F(EllipsoidDesign, GaussNewtonLowersTheObjectiveOverFeasiblePoints)
{
  const auto program = full_space_program(design);
  const Solution solution = ReducedGaussNewton().minimize(*program, {.max_iterations = 15});
  const auto& trace = solution.report.trace;
  ASSERT_GE(trace.size(), 3U);
  for (std::size_t k = 0; k < trace.size(); ++k) {
    EXPECT_LT(trace[k].infeasibility, 1e-6) << k;
    if (k > 0) {
      EXPECT_LT(trace[k].objective, trace[k - 1].objective) << k;
    }
  }
  EXPECT_LT(solution.objective, 0.3 * trace.front().objective);
  EXPECT_EQ(program->objective(solution.z), solution.objective);
  Vec c;
  program->constraints(solution.z, c);
  EXPECT_LT(c.cwiseAbs().maxCoeff(), 1e-6);
}

TEST_F(EllipsoidDesign, ObserverInterruptsAndTheBestIsKept)
{
  const auto program = full_space_program(design);
  double seen = 0;
  const Solution solution = ReducedGaussNewton().minimize(*program, {}, [&](const Iterate& iterate) {
    seen = iterate.objective;
    return iterate.k < 2;
  });
  EXPECT_EQ(solution.report.termination, Termination::Interrupted);
  EXPECT_EQ(solution.objective, seen);
  EXPECT_EQ(program->objective(solution.z), seen);
  EXPECT_LT(seen, solution.report.trace.front().objective);
}

}  // namespace
}  // namespace softform::testing
