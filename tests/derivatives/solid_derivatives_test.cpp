// Solids in the plane and in space: energy, forces, tangents, mixed and third derivatives by convergence slope, for
// every material, path and branch; and what projection promises.

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "softform/fem/solid.hpp"
#include "softform/materials/mixture.hpp"
#include "support/deformations.hpp"
#include "support/finite_differences.hpp"
#include "support/materials.hpp"
#include "support/solids.hpp"

namespace softform::testing {
namespace {

constexpr double size = 0.02;  // of the bodies [m]

template <int dim>
struct Case {
  std::string name;
  Mixture mixture;
};

std::shared_ptr<const SolidMaterial> sheet(const std::string& model) { return plane_stress(example_of(model)); }

std::shared_ptr<const SolidMaterial> rubber(double shear_modulus, NeoHookeanForm form)
{
  return neo_hookean_solid(shear_modulus, bulk_modulus(shear_modulus, 0.4), form);
}

template <int dim>
std::vector<Case<dim>> cases();

template <>
std::vector<Case<2>> cases<2>()
{
  std::vector<Case<2>> all;
  const auto stiff = plane_stress(make_material("neo_hookean", {{"mu", 3e7}}));
  for (const std::string& model : model_names()) all.push_back({model, Mixture(sheet(model))});
  for (const MixturePath path : {MixturePath::Linear, MixturePath::Simp, MixturePath::Geometric})
    all.push_back({"mixture", Mixture(sheet("neo_hookean"), stiff, path, 900, 1200)});
  return all;
}

template <>
std::vector<Case<3>> cases<3>()
{
  std::vector<Case<3>> all;
  for (const NeoHookeanForm form : {NeoHookeanForm::StressFree, NeoHookeanForm::Isochoric}) {
    all.push_back({"neo_hookean", Mixture(rubber(1e5, form))});
    all.push_back({"mixture", Mixture(rubber(1e5, form), rubber(1e8, form), MixturePath::Geometric, 900, 1200)});
  }
  return all;
}

template <int dim>
Solid<dim> small_body(const Mixture& mixture)
{
  SolidOptions<dim> options;
  if (dim == 2) options.thickness = 3e-3;
  options.gravity[0] = -9.81;
  const SimplexMesh<dim> mesh = uneven_block<dim>(size, 2);
  return Solid<dim>(mesh.elements, mesh.positions, mixture, options);
}

// Stretched, sheared and uneven, but not turned over.
Vec bent(const Vec& rest, double amount)
{
  Vec x = rest;
  for (Eigen::Index i = 0; i < x.size(); ++i) x[i] = (1 + 0.1 * double(i % 3)) * rest[i];
  return x + amount * size * wiggle(static_cast<int>(x.size()), 2);
}

template <typename Dimension>
class SolidDerivatives : public ::testing::Test {
 protected:
  static constexpr int dim = Dimension::value;

  void check(const Solid<dim>& body, const Vec& x, const Vec& rho)
  {
    const double step = 1e-3 * size;
    const Vec dx = wiggle(static_cast<int>(x.size()), 3), drho = wiggle(static_cast<int>(rho.size()), 4);
    const auto forces = [&](const Vec& y, const Vec& r) {
      Vec g;
      body.gradient(y, r, g);
      return g;
    };
    SparseMatrix K, B;
    body.hessian(x, rho, Projection::None, K);
    body.mixed_hessian(x, rho, B);
    EXPECT_SLOPE(check_slope([&](const Vec& y) { return Vec::Constant(1, body.value(y, rho)); }, x, dx,
                             Vec::Constant(1, forces(x, rho).dot(dx)), step));
    EXPECT_SLOPE(check_slope([&](const Vec& y) { return forces(y, rho); }, x, dx, K * dx, step));
    EXPECT_SLOPE(check_slope([&](const Vec& r) { return forces(x, r); }, rho, drho, B * drho, 1e-2));
  }

  // lambda . dW/dx has the gradient (K lambda, B^t lambda) in (x, rho).
  void check_third(const Solid<dim>& body, const Vec& x, const Vec& rho)
  {
    const double step = 1e-3 * size;
    const Vec lambda = wiggle(static_cast<int>(x.size()), 6);
    const Vec dx = wiggle(static_cast<int>(x.size()), 3), drho = wiggle(static_cast<int>(rho.size()), 4);
    SparseMatrix xx, mixed, K, B;
    Vec rho_rho;
    body.force_hessian(x, rho, lambda, xx, mixed, rho_rho);
    const auto by_x = [&](const Vec& y, const Vec& r) -> Vec {
      body.hessian(y, r, Projection::None, K);
      return K * lambda;
    };
    const auto by_rho = [&](const Vec& y, const Vec& r) -> Vec {
      body.mixed_hessian(y, r, B);
      return B.transpose() * lambda;
    };
    EXPECT_SLOPE(check_slope([&](const Vec& y) { return by_x(y, rho); }, x, dx, xx * dx, step));
    EXPECT_SLOPE(check_slope([&](const Vec& r) { return by_x(x, r); }, rho, drho, mixed * drho, 1e-2));
    EXPECT_SLOPE(check_slope([&](const Vec& y) { return by_rho(y, rho); }, x, dx, mixed.transpose() * dx, step));
    EXPECT_SLOPE(check_slope([&](const Vec& r) { return by_rho(x, r); }, rho, drho, rho_rho.cwiseProduct(drho), 1e-2));
  }
};

using Dimensions = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(SolidDerivatives, Dimensions);

TYPED_TEST(SolidDerivatives, OfEveryMaterialAndPath)
{
  constexpr int d = TypeParam::value;
  for (const auto& example : cases<d>()) {
    SCOPED_TRACE(example.name);
    const Solid<d> body = small_body<d>(example.mixture);
    const Vec rho = Vec::LinSpaced(body.element_count(), 0.1, 0.9), x = bent(body.rest_positions(), 0.05);
    this->check(body, x, rho);
    this->check_third(body, x, rho);
  }
}

TYPED_TEST(SolidDerivatives, AtPureMaterials)
{
  constexpr int d = TypeParam::value;
  const Mixture mixture = cases<d>().back().mixture;
  const Solid<d> body = small_body<d>(mixture);
  const Vec x = bent(body.rest_positions(), 0.05);
  for (const double rho : {0.0, 1.0}) this->check(body, x, Vec::Constant(body.element_count(), rho));
}

TEST(SolidDerivativesIn3D, OfInvertedElements)
{
  const Solid<3> body = small_body<3>(Mixture(rubber(1e5, NeoHookeanForm::StressFree)));
  Vec x = body.rest_positions();
  for (Eigen::Index i = 0; i < x.size(); i += 3) x[i] *= -0.7;
  Vec g, direction = wiggle(static_cast<int>(x.size()), 3);
  const Vec rho = Vec::Zero(body.element_count());
  ASSERT_LT(body.deformation_gradient(x, 0).determinant(), 0);
  body.gradient(x, rho, g);
  SparseMatrix K;
  body.hessian(x, rho, Projection::None, K);
  const auto forces = [&](const Vec& y) {
    Vec f;
    body.gradient(y, rho, f);
    return f;
  };
  EXPECT_SLOPE(check_slope([&](const Vec& y) { return Vec::Constant(1, body.value(y, rho)); }, x, direction,
                           Vec::Constant(1, g.dot(direction)), 1e-3 * size));
  EXPECT_SLOPE(check_slope(forces, x, direction, K * direction, 1e-3 * size));
}

// Turned-over elements have no energy where the material ends at J = 0.
TEST(SolidEnergy, IsInfiniteForInvertedElements)
{
  const Solid<2> planar = small_body<2>(Mixture(sheet("neo_hookean")));
  const Solid<3> spatial = small_body<3>(Mixture(rubber(1e5, NeoHookeanForm::Isochoric)));
  const auto mirrored = [](Vec x, int dim) {
    for (Eigen::Index i = 0; i < x.size(); i += dim) x[i] *= -1;
    return x;
  };
  constexpr double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(planar.value(mirrored(planar.rest_positions(), 2), Vec::Zero(planar.element_count())), infinity);
  EXPECT_EQ(spatial.value(mirrored(spatial.rest_positions(), 3), Vec::Zero(spatial.element_count())), infinity);
}

// The projected Hessian is the true one with its negative eigenvalues cut off: an eigensolver is the judge.
template <int dim>
void check_projection(const SolidMaterial& material, const Gradient<dim>& F)
{
  const SolidDensity density = material.density(F.squaredNorm(), F.determinant(), Order::Hessian);
  const GradientHessian<dim> H = stress_derivative<dim>(density, F);
  const Eigen::SelfAdjointEigenSolver<GradientHessian<dim>> eigen(H);
  const GradientHessian<dim> expected =
      eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0).asDiagonal() * eigen.eigenvectors().transpose();
  EXPECT_LT((projected_stress_derivative<dim>(density, F) - expected).norm(), 1e-10 * H.norm());
}

TEST(Projection, CutsTheNegativeEigenvalues)
{
  const auto planar = sheet("mooney_rivlin");
  const auto stress_free = rubber(1e5, NeoHookeanForm::StressFree), isochoric = rubber(1e5, NeoHookeanForm::Isochoric);
  int indefinite = 0;
  for (int k = 1; k < 40; ++k) {
    Gradient<2> F2 = Eigen::Map<const Gradient<2>>(wiggle(4, k).data()) + 0.5 * Gradient<2>::Identity();
    if (F2.determinant() < 0) F2.col(0) *= -1;
    const Vec entries = wiggle(9, k);
    Gradient<3> F3 = Eigen::Map<const Gradient<3>>(entries.data()) + 0.5 * Gradient<3>::Identity();
    check_projection<2>(*planar, F2);
    check_projection<3>(*stress_free, F3);
    const SolidDensity density = stress_free->density(F3.squaredNorm(), F3.determinant(), Order::Hessian);
    indefinite += stress_derivative<3>(density, F3).eigenvalues().real().minCoeff() < 0;
    if (F3.determinant() < 0) F3.col(0) *= -1;
    check_projection<3>(*isochoric, F3);
  }
  EXPECT_GT(indefinite, 10);
}

}  // namespace
}  // namespace softform::testing
