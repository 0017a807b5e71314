// Solids against closed forms: uniform strain on uneven meshes, stress-free rest, weight, and the elastica.

#include <array>
#include <cmath>
#include <memory>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "softform/equilibrium/loaded_solid.hpp"
#include "softform/materials/registry.hpp"
#include "support/deformations.hpp"
#include "support/solids.hpp"

namespace softform::testing {
namespace {

template <int dim>
std::shared_ptr<const SolidMaterial> rubber(double shear_modulus)
{
  if constexpr (dim == 2)
    return plane_stress(make_material("neo_hookean", {{"mu", shear_modulus}}));
  else
    return neo_hookean_solid(shear_modulus, bulk_modulus(shear_modulus, 0.4));
}

/// Holds every vertex for which `is_held` is true.
template <int dim, class IsHeld>
FixedDofs hold(const SimplexMesh<dim>& mesh, const IsHeld& is_held)
{
  FixedDofs fixed{Vec::Ones(mesh.positions.size())};
  for (int i = 0; i < mesh.vertex_count(); ++i)
    if (is_held(mesh.positions.template segment<dim>(dim * i))) fixed.free.template segment<dim>(dim * i).setZero();
  return fixed;
}

template <int dim>
void check_patch()
{
  const double size = 0.02;
  const SimplexMesh<dim> mesh = uneven_block<dim>(size, 3);
  const Solid<dim> body(mesh.elements, mesh.positions, Mixture(rubber<dim>(1e5)));
  const Gradient<dim> F =
      Gradient<dim>::Identity() + 0.3 * Gradient<dim>(Eigen::Map<const Gradient<dim>>(wiggle(dim * dim, 2).data()));
  Vec exact(mesh.positions.size());
  for (int i = 0; i < mesh.vertex_count(); ++i)
    exact.template segment<dim>(dim * i) = F * mesh.positions.template segment<dim>(dim * i);
  const FixedDofs boundary =
      hold<dim>(mesh, [&](const Point<dim>& X) { return X.minCoeff() < 1e-9 || X.maxCoeff() > size - 1e-9; });
  Vec start = exact + 0.03 * size * boundary.free.cwiseProduct(wiggle(static_cast<int>(exact.size()), 5));
  SparseFactorization factorization;
  const LoadedSolid<dim> potential(body, Vec::Zero(body.element_count()));
  const Equilibrium found = solve_equilibrium(potential, start, factorization, {}, boundary);
  ASSERT_TRUE(found.report.converged()) << found.report.message;
  EXPECT_GT((start - exact).norm(), 1e-3 * size);
  EXPECT_LT((found.x - exact).lpNorm<Eigen::Infinity>(), 1e-9 * size);
}

TEST(PatchTest, UniformStrainInThePlane) { check_patch<2>(); }
TEST(PatchTest, UniformStrainInSpace) { check_patch<3>(); }

TEST(SolidAtRest, IsStressFree)
{
  const SimplexMesh<3> mesh = uneven_block<3>(0.02, 2);
  for (const NeoHookeanForm form : {NeoHookeanForm::StressFree, NeoHookeanForm::Isochoric}) {
    const Solid<3> body(mesh.elements, mesh.positions, Mixture(neo_hookean_solid(1e5, 4e5, form)));
    Vec g;
    body.gradient(mesh.positions, Vec::Zero(body.element_count()), g);
    EXPECT_LT(g.lpNorm<Eigen::Infinity>(), 1e-12 * 1e5 * 0.02 * 0.02);
  }
}

// Linear elasticity at small strain: the forms differ only beyond it.
TEST(SolidAtRest, HasTheModuliOfItsMaterial)
{
  const double G = 1e5, kappa = 4e5, e = 1e-6;
  for (const NeoHookeanForm form : {NeoHookeanForm::StressFree, NeoHookeanForm::Isochoric}) {
    const auto material = neo_hookean_solid(G, kappa, form);
    const auto stress_at = [&](const Gradient<3>& F) {
      return stress<3>(material->density(F.squaredNorm(), F.determinant(), Order::Gradient), F);
    };
    Gradient<3> shear = Gradient<3>::Identity();
    shear(0, 1) = e;
    EXPECT_NEAR(stress_at(shear)(0, 1) / (G * e), 1, 1e-5);
    EXPECT_NEAR(stress_at((1 + e) * Gradient<3>::Identity())(0, 0) / (3 * kappa * e), 1, 1e-5);
  }
}

TEST(Gravity, WeighsWhatTheMaterialsWeigh)
{
  const SimplexMesh<3> mesh = uneven_block<3>(0.02, 2);
  SolidOptions<3> options;
  options.gravity = {0, 0, -9.81};
  const Mixture mixture(rubber<3>(1e5), rubber<3>(1e6), MixturePath::Geometric, 1000, 1500);
  const Solid<3> body(mesh.elements, mesh.positions, mixture, options);
  Vec g;
  body.gradient(mesh.positions, Vec::Constant(body.element_count(), 0.5), g);
  EXPECT_NEAR(unflatten(g).col(2).sum(), 1250 * std::pow(0.02, 3) * 9.81, 1e-12);
}

TEST(SolidInput, TurnedElementsAreNamed)
{
  SimplexMesh<2> mesh = grid<2>({1, 1}, {2, 2});
  std::swap(mesh.elements(3, 0), mesh.elements(3, 1));
  try {
    Solid<2>(mesh.elements, mesh.positions, Mixture(rubber<2>(1e5)));
    FAIL();
  } catch (const std::exception& error) {
    EXPECT_NE(std::string(error.what()).find("element 3"), std::string::npos) << error.what();
  }
}

// The inextensible cantilever under a dead load at its tip (elliptic integrals; Bisshopp and Drucker 1945):
// deflection w/L and shortening u/L at P L^2/EI.
struct Elastica {
  double load, w, u;
};
constexpr std::array<Elastica, 3> elastica{
    {{1, 0.3017207738, 0.0564332363}, {5, 0.7137915236, 0.3876283607}, {10, 0.8106090249, 0.5549955978}}};

struct TipErrors {
  std::array<double, 3> error;           // relative, at each load
  std::array<Point<2>, 3> displacement;  // [m]
};

// E = 3 G, EI = E b h^3/12, L/h = 20.
TipErrors cantilever(int cells)
{
  const double L = 0.1, h = 0.005, G = 1e5, thickness = 0.01;
  const SimplexMesh<2> mesh = grid<2>({L, h}, {20 * cells, cells});
  SolidOptions<2> options;
  options.thickness = thickness;
  const Solid<2> body(mesh.elements, mesh.positions, Mixture(rubber<2>(G)), options);
  const FixedDofs clamp = hold<2>(mesh, [](const Point<2>& X) { return X.x() < 1e-9; });
  Vec tip = Vec::Zero(mesh.vertex_count());  // each vertex' share of the end face
  for (int i = 0; i < mesh.vertex_count(); ++i) {
    const double y = mesh.positions[2 * i + 1];
    if (mesh.positions[2 * i] > L - 1e-9) tip[i] = (y < 1e-9 || y > h - 1e-9 ? 0.5 : 1.0) / cells;
  }
  SparseFactorization factorization;
  Vec x = mesh.positions;
  TipErrors result;
  for (std::size_t k = 0; k < elastica.size(); ++k) {
    Vec loads = Vec::Zero(x.size());
    for (int i = 0; i < mesh.vertex_count(); ++i)
      loads[2 * i + 1] = -tip[i] * elastica[k].load * 3 * G * thickness * h * h * h / 12 / (L * L);
    const LoadedSolid<2> potential(body, Vec::Zero(body.element_count()), loads);
    const Equilibrium found = solve_equilibrium(potential, x, factorization, {}, clamp);
    EXPECT_TRUE(found.report.converged()) << found.report.message;
    x = found.x;
    Point<2>& u = result.displacement[k] = Point<2>::Zero();
    for (int i = 0; i < mesh.vertex_count(); ++i) u += tip[i] * (x - mesh.positions).segment<2>(2 * i);
    const Point<2> exact(-elastica[k].u * L, -elastica[k].w * L);
    result.error[k] = (u - exact).norm() / exact.norm();
  }
  return result;
}

// Linear triangles lock in bending: 4 cells through the thickness are far too stiff. The displacement converges with
// second order in the mesh size; what is left of the error at the end is also the bar's thickness, which the closed
// form has not.
TEST(ElasticaBenchmark, ConvergesToTheClosedForm)
{
  const TipErrors coarse = cantilever(4), middle = cantilever(8), fine = cantilever(16);
  for (std::size_t k = 0; k < elastica.size(); ++k) {
    SCOPED_TRACE("load " + std::to_string(elastica[k].load) + ", errors " + std::to_string(coarse.error[k]) + " " +
                 std::to_string(middle.error[k]) + " " + std::to_string(fine.error[k]));
    EXPECT_LT(fine.error[k], 0.01);
    EXPECT_LT(fine.error[k], middle.error[k]);
    const double ratio = (middle.displacement[k] - coarse.displacement[k]).norm() /
                         (fine.displacement[k] - middle.displacement[k]).norm();
    EXPECT_GT(std::log2(ratio), 1.7);
    EXPECT_LT(std::log2(ratio), 2.3);
  }
}

}  // namespace
}  // namespace softform::testing
