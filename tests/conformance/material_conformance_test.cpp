// What every registered material must satisfy.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "softform/core/error.hpp"
#include "support/finite_differences.hpp"
#include "support/materials.hpp"

namespace softform {
namespace {

using testing::energy;

class MaterialConformance : public ::testing::TestWithParam<std::string> {
 protected:
  const Material& material() const { return *material_; }

 private:
  std::unique_ptr<Material> material_ = testing::example_of(GetParam());
};

INSTANTIATE_TEST_SUITE_P(Registry, MaterialConformance, ::testing::ValuesIn(testing::model_names()),
                         [](const auto& test) { return test.param; });

TEST_P(MaterialConformance, ReportsWhatItWasMadeOf)
{
  std::map<std::string, double> given;
  for (const MaterialParameter& parameter : material().parameters()) given[parameter.name] = parameter.value;
  const auto copy = make_material(material().model(), given);
  EXPECT_EQ(energy(*copy, 1.7, 1.2), energy(material(), 1.7, 1.2));
}

TEST_P(MaterialConformance, RestIsFreeOfEnergyAndStress)
{
  const MembraneDensity rest = material().density(2, 1, Order::Gradient);
  const double mu = material().shear_modulus();
  EXPECT_NEAR(rest.psi, 0, 1e-14 * mu);
  // dW/dlambda_1 = 2 lambda_1 (psi_t + lambda_2^2 psi_d)
  EXPECT_NEAR(2 * (rest.psi_t + rest.psi_d), 0, 1e-14 * mu);
}

TEST_P(MaterialConformance, ShearModulusIsTheStiffnessAtRest)
{
  // Incompressible and isotropic: d2W/dlambda_1^2 = 4 mu, d2W/dlambda_1 dlambda_2 = 2 mu at rest.
  const double mu = material().shear_modulus();
  ASSERT_GT(mu, 0);
  const MembraneDensity rest = material().density(2, 1, Order::Hessian);
  const double curvature = rest.psi_tt + 2 * rest.psi_td + rest.psi_dd;
  EXPECT_NEAR(4 * curvature + 2 * (rest.psi_t + rest.psi_d), 4 * mu, 1e-12 * mu);
  EXPECT_NEAR(4 * (curvature + rest.psi_d), 2 * mu, 1e-12 * mu);
}

TEST_P(MaterialConformance, StretchingCostsEnergy)
{
  for (const auto& [l1, l2] : {std::pair(1.01, 1.0), {0.9, 1.0}, {1.3, 1.3}, {2.0, 0.8}, {0.7, 0.7}, {4.0, 3.0}})
    EXPECT_GT(energy(material(), l1, l2), 0) << l1 << " " << l2;
}

TEST_P(MaterialConformance, SymmetricInTheThreePrincipalStretches)
{
  // An isotropic, incompressible energy cannot tell lambda_1, lambda_2 and lambda_3 = 1/(lambda_1 lambda_2) apart.
  for (const auto& [l1, l2] : {std::pair(1.3, 0.9), {2.0, 1.1}, {1.5, 1.5}}) {
    const double W = energy(material(), l1, l2), l3 = 1 / (l1 * l2);
    EXPECT_NEAR(energy(material(), l2, l1), W, 1e-13 * W);
    EXPECT_NEAR(energy(material(), l1, l3), W, 1e-12 * W);
    EXPECT_NEAR(energy(material(), l3, l2), W, 1e-12 * W);
  }
}

TEST_P(MaterialConformance, InfiniteOutsideItsDomain)
{
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (const auto& [t, d] : {std::pair(2.0, 0.0),
                             {2.0, -1.0},
                             {1.0, 1.0},
                             {-2.0, 1.0},
                             {1e308, 1e308},
                             {2.0, 1e-310},
                             {std::nan(""), 1.0},
                             {2.0, std::nan("")}}) {
    for (const Order order : {Order::Value, Order::Third}) {
      const MembraneDensity density = material().density(t, d, order);
      EXPECT_EQ(density.psi, infinity) << t << " " << d;
      EXPECT_EQ(density.psi_t, 0);
    }
  }
}

TEST_P(MaterialConformance, LowerOrdersAgreeWithHigherOnes)
{
  const MembraneDensity full = material().density(3.1, 1.7, Order::Third);
  EXPECT_EQ(material().density(3.1, 1.7, Order::Value).psi, full.psi);
  EXPECT_EQ(material().density(3.1, 1.7, Order::Value).psi_t, 0);
  EXPECT_EQ(material().density(3.1, 1.7, Order::Gradient).psi_d, full.psi_d);
  EXPECT_EQ(material().density(3.1, 1.7, Order::Gradient).psi_dd, 0);
  EXPECT_EQ(material().density(3.1, 1.7, Order::Hessian).psi_td, full.psi_td);
  EXPECT_EQ(material().density(3.1, 1.7, Order::Hessian).psi_ddd, 0);
}

TEST_P(MaterialConformance, NamesMissingAndUnknownParameters)
{
  std::map<std::string, double> given;
  for (const MaterialParameter& parameter : material().parameters()) given[parameter.name] = parameter.value;
  const std::string first = given.begin()->first;

  auto not_finite = given;
  not_finite[first] = std::nan("");
  EXPECT_THROW(make_material(material().model(), not_finite), InputError);

  auto renamed = given;
  renamed.erase(first);
  renamed["stiffness"] = 1;
  EXPECT_THROW(make_material(material().model(), renamed), InputError);

  given["stiffness"] = 1;
  EXPECT_THROW(make_material(material().model(), given), InputError);
}

}  // namespace
}  // namespace softform
