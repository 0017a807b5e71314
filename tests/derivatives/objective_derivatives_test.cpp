#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "softform/mesh/shapes.hpp"
#include "softform/objectives/collision_penalty.hpp"
#include "softform/objectives/edge_dihedral.hpp"
#include "softform/objectives/vertex_distance.hpp"
#include "softform/objectives/volume_reward.hpp"
#include "support/deformations.hpp"
#include "support/finite_differences.hpp"

namespace softform::testing {
namespace {

constexpr double radius = 0.05;

void check_gradient(const Objective& objective, const Vec& x)
{
  Vec g;
  objective.gradient(x, g);
  const Vec direction = wiggle(static_cast<int>(x.size()), 3);
  EXPECT_SLOPE(check_slope([&](const Vec& y) { return Vec::Constant(1, objective.value(y)); }, x, direction,
                           Vec::Constant(1, g.dot(direction)), 1e-3 * radius));
}

void check_hessian(const Objective& objective, const Vec& x)
{
  const auto gradient = [&](const Vec& y) {
    Vec g;
    objective.gradient(y, g);
    return g;
  };
  SparseMatrix H;
  ASSERT_TRUE(objective.hessian(x, H));
  const Vec direction = wiggle(static_cast<int>(x.size()), 7);
  EXPECT_SLOPE(check_slope(gradient, x, direction, H * direction, 1e-3 * radius));
}

// At a zero residual the Gauss-Newton Hessian is the true one.
void check_gauss_newton_at_zero_residual(const Objective& objective, const Vec& x)
{
  const auto gradient = [&](const Vec& y) {
    Vec g;
    objective.gradient(y, g);
    return g;
  };
  ASSERT_LT(gradient(x).norm(), 1e-9);
  SparseMatrix H;
  objective.gauss_newton_hessian(x, H);
  const Vec direction = wiggle(static_cast<int>(x.size()), 7);
  EXPECT_SLOPE(check_slope(gradient, x, direction, H * direction, 1e-3 * radius));
}

void check_positive_semidefinite(const Objective& objective, const Vec& x)
{
  SparseMatrix H;
  objective.gauss_newton_hessian(x, H);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen{Eigen::MatrixXd(H)};
  EXPECT_GE(eigen.eigenvalues().minCoeff(), -1e-10 * eigen.eigenvalues().maxCoeff());
}

TEST(EdgeDihedralDerivatives, StretchAndBending)
{
  const TriangleMesh mesh = sphere(radius, 60);
  const EdgeDihedralDistance objective(mesh.triangles, flatten(mesh.vertices), {1, 0.1});
  check_gradient(objective, deformed(mesh));
  check_hessian(objective, deformed(mesh));
  check_gauss_newton_at_zero_residual(objective, flatten(mesh.vertices));
  check_positive_semidefinite(objective, deformed(mesh));
}

// The angle's sign and gradient on both branches: a ridge and a valley.
TEST(EdgeDihedralDerivatives, AngleOfRidgeAndValley)
{
  for (const double height : {0.3, -0.3}) {
    Vec x(12);
    x << 0, 0, 0, 1, 0, 0, 0.3, 1, -height, 0.6, -1.2, -height;
    const auto angle = [](const Vec& y) {
      return Vec::Constant(1, dihedral_angle(y.segment<3>(0), y.segment<3>(3), y.segment<3>(6), y.segment<3>(9)));
    };
    EXPECT_GT(angle(x)[0] * height, 0);
    const Vec direction = wiggle(12, 2);
    const double exact =
        dihedral_gradient(x.segment<3>(0), x.segment<3>(3), x.segment<3>(6), x.segment<3>(9)).dot(direction);
    EXPECT_SLOPE(check_slope(angle, x, direction, Vec::Constant(1, exact), 1e-2));
  }
}

TEST(EdgeDihedralDerivatives, AnOpenSurfaceHasBoundaryEdgesWithoutAngle)
{
  Triangles triangles(2, 3);
  triangles << 0, 1, 2, 1, 0, 3;
  Vec target(12), x(12);
  target << 0, 0, 0, 1, 0, 0, 0.3, 1, 0, 0.6, -1.2, 0;
  x << 0, 0, 0.1, 1.2, 0, 0, 0.3, 1, 0.3, 0.6, -1.2, 0.4;
  const EdgeDihedralDistance objective(triangles, target, {1, 0.1});
  check_gradient(objective, x);
  check_hessian(objective, x);
  check_positive_semidefinite(objective, x);
}

TEST(AlignedVertexDistanceDerivatives, GradientThroughTheAlignment)
{
  const TriangleMesh mesh = sphere(radius, 60);
  const AlignedVertexDistance objective(mesh.triangles, flatten(mesh.vertices));
  check_gradient(objective, deformed(mesh));
  check_positive_semidefinite(objective, deformed(mesh));
}

TEST(AlignedVertexDistance, DoesNotSeeRigidMotions)
{
  const TriangleMesh mesh = sphere(radius, 60);
  const AlignedVertexDistance objective(mesh.triangles, flatten(mesh.vertices));
  const Eigen::Matrix3d R = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  const Positions moved = (mesh.vertices * R.transpose()).rowwise() + Eigen::RowVector3d(0.1, -0.2, 0.3);
  EXPECT_NEAR(objective.value(flatten(moved)), 0, 1e-20);
}

// Two sheets of the sphere pressed together, so that pairs of its far sides are close; and far apart, where none is.
TEST(CollisionPenaltyDerivatives, ActiveAndInactive)
{
  const TriangleMesh mesh = sphere(radius, 200);
  const Vec rest = flatten(mesh.vertices);
  const CollisionPenalty objective(mesh.triangles, rest, 0.3 * radius, 0.9 * radius);
  Positions flat = mesh.vertices;
  flat.col(2) *= 0.05;
  EXPECT_GT(objective.value(flatten(flat)), 0);
  check_gradient(objective, flatten(flat));
  check_positive_semidefinite(objective, flatten(flat));
  EXPECT_EQ(objective.value(rest), 0);
  Vec g;
  objective.gradient(rest, g);
  EXPECT_EQ(g.norm(), 0);
}

// The thesis prints (d - eps)^3, which would attract.
TEST(CollisionPenalty, PushesApart)
{
  const TriangleMesh mesh = sphere(radius, 200);
  const CollisionPenalty objective(mesh.triangles, flatten(mesh.vertices), 0.3 * radius, 0.9 * radius);
  Positions flat = mesh.vertices, flatter = mesh.vertices;
  flat.col(2) *= 0.10;
  flatter.col(2) *= 0.05;
  EXPECT_GT(objective.value(flatten(flatter)), objective.value(flatten(flat)));
}

TEST(VolumeRewardDerivatives, Gradient)
{
  const TriangleMesh mesh = sphere(radius, 60);
  check_gradient(VolumeReward(mesh.triangles, flatten(mesh.vertices)), deformed(mesh));
}

}  // namespace
}  // namespace softform::testing
