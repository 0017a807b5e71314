#include "softform/inflatables/flatten.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "softform/inflatables/boundary_flattening.hpp"
#include "softform/inflatables/symmetric_dirichlet.hpp"
#include "support/deformations.hpp"
#include "support/expect_input_error.hpp"
#include "support/finite_differences.hpp"

namespace softform {
namespace {

using testing::check_slope;
using testing::wiggle;

/// A grid of triangles with the vertices place(i / (n - 1), j / (n - 1)), facing along d/du x d/dv.
template <class Place>
TriangleMesh patch(int n, const Place& place)
{
  TriangleMesh mesh;
  mesh.vertices.resize(n * n, 3);
  mesh.triangles.resize(2 * (n - 1) * (n - 1), 3);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) mesh.vertices.row(i * n + j) = place(i / (n - 1.0), j / (n - 1.0)).transpose();
  int t = 0;
  for (int i = 0; i + 1 < n; ++i) {
    for (int j = 0; j + 1 < n; ++j) {
      const int a = i * n + j, b = a + n, c = b + 1, d = a + 1;
      mesh.triangles.row(t++) << a, b, c;
      mesh.triangles.row(t++) << a, c, d;
    }
  }
  return mesh;
}

/// Facets that meet in rulings unfold without any stretch: so do these, exactly.
TriangleMesh cylinder_patch()
{
  return patch(9, [](double u, double v) -> Vec3 { return Vec3(std::cos(2 * u), std::sin(2 * u), 0.8 * v + 0.3 * u); });
}
TriangleMesh cone_patch()
{
  return patch(9, [](double u, double v) -> Vec3 { return (1 + v) * Vec3(std::cos(1.5 * u), std::sin(1.5 * u), 0.7); });
}
TriangleMesh cap()
{
  return patch(7, [](double u, double v) -> Vec3 { return Vec3(u, v, std::sin(2 * u) * std::cos(v)); });
}

PanelLayout layout_of(const TriangleMesh& mesh)
{
  PanelLayout layout{
      mesh.vertices, mesh.triangles, {}, {}, {{"p", false, 0, mesh.vertex_count(), 0, mesh.triangle_count()}}, {}};
  for (int v = 0; v < mesh.vertex_count(); ++v) layout.node_of.push_back(v);
  layout.flat.resize(mesh.vertex_count(), 2);
  return layout;
}

std::vector<int> loop_of(const TriangleMesh& mesh) { return boundary_loops(mesh.triangles).front(); }

Vec number(double value) { return Vec::Constant(1, value); }

TEST(Flatten, DevelopablePatchesFlattenIsometrically)
{
  for (const TriangleMesh& mesh : {cylinder_patch(), cone_patch()}) {
    PanelLayout layout = layout_of(mesh);
    flatten_panels(layout);
    EXPECT_LT(distortion(layout, 0).max, 1e-4);
    const FlatPositions boundary = flat_boundary(boundary_shape(mesh, loop_of(mesh)));
    const std::vector<int> loop = loop_of(mesh);
    for (std::size_t i = 0; i < loop.size(); ++i)  // congruent with the other method's
      for (std::size_t k = 0; k < i; ++k)
        EXPECT_NEAR((boundary.row(static_cast<Eigen::Index>(i)) - boundary.row(static_cast<Eigen::Index>(k))).norm(),
                    (layout.flat.row(loop[i]) - layout.flat.row(loop[k])).norm(), 1e-3);
  }
}

TEST(Flatten, BoundaryOfADevelopablePatchHasNoResidual)
{
  const TriangleMesh mesh = cone_patch();
  const BoundaryFlattening program(boundary_shape(mesh, loop_of(mesh)));
  const FlatPositions q = flat_boundary(boundary_shape(mesh, loop_of(mesh)));
  EXPECT_LT(program.objective(Eigen::Map<const Vec>(q.data(), q.size())), 1e-12);
}

TEST(Flatten, HemisphereLuneKeepsItsEdges)
{
  PanelLayout layout = three_lune_sphere(0.3, 8);
  const PanelLayout sinusoidal = layout;
  flatten_panels(layout);
  for (const Seam& seam : layout.seams) {
    const auto lengths = side_lengths(layout, seam);
    const double meridian = 0.3 * 32 * std::sin(std::numbers::pi / 32);  // 16 chords from pole to pole
    EXPECT_NEAR(lengths[0] / meridian, 1, 0.01);
    EXPECT_NEAR(lengths[1] / lengths[0], 1, 0.002);
  }
  // Less stretch and less change of the boundary's lengths, together, than the sinusoidal development.
  const TriangleMesh lune = panel_mesh(layout, 0);
  const SymmetricDirichlet energy(lune, loop_of(lune), FlatteningOptions{}.length_weight,
                                  tutte_disc(lune, loop_of(lune)));
  const auto value = [&](const PanelLayout& of) {
    const FlatPositions flat = of.flat.topRows(lune.vertex_count());
    return energy.objective(Eigen::Map<const Vec>(flat.data(), flat.size()));
  };
  EXPECT_GT(value(layout), 4);  // no isometry: a sphere has none
  EXPECT_LT(value(layout), value(sinusoidal));
}

TEST(Flatten, TutteDiscHasNoFolds)
{
  const TriangleMesh mesh = cap();
  const FlatPositions flat = tutte_disc(mesh, loop_of(mesh));
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    const Eigen::RowVector2d a = flat.row(mesh.triangles(t, 1)) - flat.row(mesh.triangles(t, 0));
    const Eigen::RowVector2d b = flat.row(mesh.triangles(t, 2)) - flat.row(mesh.triangles(t, 0));
    EXPECT_GT(a[0] * b[1] - a[1] * b[0], 0);
  }
}

TEST(Flatten, DerivativesOfTheSymmetricDirichletEnergy)
{
  const TriangleMesh mesh = cap();
  const SymmetricDirichlet program(mesh, loop_of(mesh), 10, tutte_disc(mesh, loop_of(mesh)));
  const Vec z = program.initial_point(), direction = 0.01 * wiggle(program.variable_count(), 3);
  Vec g;
  program.objective_gradient(z, g);
  EXPECT_SLOPE(check_slope([&](const Vec& y) { return number(program.objective(y)); }, z, direction,
                           number(g.dot(direction)), 0.5));
  SparseMatrix H;
  ASSERT_TRUE(program.lagrangian_hessian(z, Vec(), H));
  const auto gradient = [&](const Vec& y) {
    Vec result;
    program.objective_gradient(y, result);
    return result;
  };
  EXPECT_SLOPE(check_slope(gradient, z, direction, H * direction, 0.5));
  // The projected Hessian is semi-definite and never below the true one.
  SparseMatrix P;
  program.gauss_newton_hessian(z, P);
  for (int seed = 1; seed < 20; ++seed) {
    const Vec v = wiggle(program.variable_count(), seed);
    EXPECT_GE(v.dot(P * v), 0);
    EXPECT_GE(v.dot(P * v) - v.dot(H * v), -1e-9);
  }
}

TEST(Flatten, FoldsAreInfinitelyBad)
{
  const TriangleMesh mesh = cap();
  FlatPositions folded = tutte_disc(mesh, loop_of(mesh));
  folded.col(0) *= -1;
  const SymmetricDirichlet program(mesh, loop_of(mesh), 1, folded);
  EXPECT_EQ(program.objective(program.initial_point()), std::numeric_limits<double>::infinity());
}

TEST(Flatten, DerivativesOfTheBoundaryFlattening)
{
  const TriangleMesh mesh = cap();
  const BoundaryFlattening program(boundary_shape(mesh, loop_of(mesh)));
  const Vec z = program.initial_point(), direction = 0.01 * wiggle(program.variable_count(), 3);
  const auto residuals = [&](const Vec& y) {
    Vec r;
    program.residuals(y, r);
    return r;
  };
  SparseMatrix R;
  program.residual_jacobian(z, R);
  EXPECT_SLOPE(check_slope(residuals, z, direction, R * direction, 0.5));
}

TEST(Flatten, MethodsHaveNames)
{
  EXPECT_EQ(flattening_method("boundary"), FlatteningMethod::Boundary);
  test::expect_input_error([] { flattening_method("iron"); }, {"'iron'", "symmetric-dirichlet", "boundary"});
}

}  // namespace
}  // namespace softform
