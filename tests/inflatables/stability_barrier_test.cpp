// Soft modes and the barrier against them, on an inflated sphere of three lunes.

#include <cmath>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "softform/inflatables/pattern_optimization.hpp"
#include "softform/inflatables/sheet_material.hpp"
#include "softform/inflatables/stability_barrier.hpp"
#include "softform/materials/registry.hpp"
#include "softform/mesh/shapes.hpp"
#include "support/deformations.hpp"
#include "support/finite_differences.hpp"

namespace softform::testing {
namespace {

class InflatedSphere : public ::testing::Test {
 protected:
  InflatedSphere()
  {
    inflation = design_inflation(*make_material("neo_hookean", {{"mu", 1.6e5}}), 1e-3, 1, 2);
    inflation.first_material = nullptr;
    inflation.newton.tolerance = 1e-11;
    panels = inflated_panels(three_lune_sphere(1, 4), inflation);
    inflatable = std::make_unique<Inflatable>(panels.layout, inflation.material, inflation.thickness, 1);
    masses = Vec::Ones(panels.x.size()) + 0.5 * wiggle(static_cast<int>(panels.x.size()), 3);
    inflatable->hessian(panels.x, flat_vector(panels.layout), K);
  }
  /// The lowest eigenvalues of K v = sigma M v by dense algebra.
  Vec dense_spectrum() const
  {
    return Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(K, Eigen::MatrixXd(masses.asDiagonal()))
        .eigenvalues();
  }
  /// (6.16) with nothing but the barrier, which begins at p / unit_length.
  std::unique_ptr<FullSpaceProgram> barrier_program(double unit_length) const
  {
    PatternObjectiveSettings settings;
    settings.weights = {.distance = 0, .seams = 0, .length = 0, .boundary = 0, .interior = 0, .stability = 1e-3};
    settings.unit_length = unit_length;
    const auto target = std::make_shared<ImlsField>(imls_field(irregular_sphere(1, 1000)));
    return pattern_program(panels.layout, panels.x, inflation, target, settings);
  }

  InflationSettings inflation;
  InflatedPanels panels;
  std::unique_ptr<Inflatable> inflatable;
  SparseMatrix K;
  Vec masses;
  SparseFactorization factorization;
};

TEST_F(InflatedSphere, SoftModesAreTheLowestEigenvaluesBeyondRigidMotions)
{
  const SoftModes modes = soft_modes(K, masses, panels.x, 4, factorization);
  ASSERT_EQ(modes.stiffness.size(), 4);
  const Vec dense = dense_spectrum();
  EXPECT_LT(dense.head(6).cwiseAbs().maxCoeff(), 1e-6 * dense[6]);
  for (int i = 0; i < 4; ++i) {
    EXPECT_NEAR(modes.stiffness[i], dense[6 + i], 1e-6 * dense[6 + i]);
    const Vec v = modes.shapes.col(i), Mv = masses.cwiseProduct(v);
    EXPECT_NEAR(v.dot(Mv), 1, 1e-9);
    EXPECT_LT((K * v - modes.stiffness[i] * Mv).norm(), 1e-4 * (K * v).norm());
  }
}

TEST_F(InflatedSphere, HasNoMoreModesThanAFewNodesAllow)
{
  const int size = 12;
  const Vec diagonal = Vec::LinSpaced(size, 1, 2);
  const SparseMatrix stiff = Eigen::MatrixXd(diagonal.asDiagonal()).sparseView();
  const SoftModes modes = soft_modes(stiff, Vec::Ones(size), wiggle(size, 1), 24, factorization);
  ASSERT_EQ(modes.stiffness.size(), size - 7);
  EXPECT_GT(modes.stiffness.minCoeff<Eigen::PropagateNaN>(), 1);
  EXPECT_LT(modes.stiffness.maxCoeff<Eigen::PropagateNaN>(), 2);
}

TEST_F(InflatedSphere, HasNoSoftModesWhereItIsNotStable)
{
  const Vec small = 0.5 * panels.x, flat = flat_vector(panels.layout);
  inflatable->hessian(small, flat, K);
  EXPECT_EQ(soft_modes(K, masses, small, 4, factorization).stiffness.size(), 0);
  Vec z(small.size() + flat.size());
  z << small, flat;
  EXPECT_EQ(barrier_program(0.05)->objective(z), HUGE_VAL);
}

// An ear on a slack neck tipped over where nothing kept the softest mode of a bear's design stiff.
TEST_F(InflatedSphere, TheBarrierMakesTheDesignStiffer)
{
  const auto program = barrier_program(0.1);
  const auto softest = [&](ConstVec z) {
    inflatable->hessian(program->state(z), program->design(z), K);
    return soft_modes(K, Vec::Ones(panels.x.size()), program->state(z), 1, factorization).stiffness[0];
  };
  StopCriteria stop;
  stop.max_iterations = 8;
  const Solution solution = FeasibleNewton().minimize(*program, stop);
  const Vec first = *program->restore(program->initial_point());
  EXPECT_LT(solution.objective, 0.8 * program->objective(first));
  EXPECT_GT(softest(solution.z), 1.05 * softest(first));
}

// Where no mode, some and many are within its reach, as the design moves and the equilibrium with it.
TEST_F(InflatedSphere, TheBarrierHasItsReducedGradient)
{
  for (const double unit_length : {2.0, 0.1, 0.06}) {
    SCOPED_TRACE(unit_length);
    const auto program = barrier_program(unit_length);
    const Vec z = *program->restore(program->initial_point());
    const Vec direction = wiggle(2 * panels.layout.vertex_count(), 5);
    const auto objective = [&](const Vec& step) {
      Vec moved = z;
      moved.tail(direction.size()) += step;
      return Vec::Constant(1, program->objective(*program->restore(moved)));
    };
    Vec g;
    SparseMatrix J;
    program->objective_gradient(z, g);
    program->constraint_jacobian(z, J);
    const Vec reduced = g + J.transpose() * *program->adjoint_multipliers(z);
    EXPECT_LT(reduced.head(panels.x.size()).lpNorm<Eigen::Infinity>(), 1e-5 * (1e-12 + g.lpNorm<Eigen::Infinity>()));
    if (unit_length == 2.0) {
      EXPECT_EQ(program->objective(z), 0);
      EXPECT_EQ(g.norm(), 0);
      EXPECT_EQ(program->dense_curvature(z).cols(), 0);
      continue;
    }
    EXPECT_GT(program->dense_curvature(z).cols(), 0);
    EXPECT_SLOPE(check_slope(objective, Vec(Vec::Zero(direction.size())), direction,
                             Vec::Constant(1, reduced.tail(direction.size()).dot(direction)), 3e-4));
  }
}

}  // namespace
}  // namespace softform::testing
