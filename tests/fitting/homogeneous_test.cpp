// Homogeneous tests of every registered material: stresses against differences of the energy and closed forms, exact
// derivatives by the parameters, the work in logarithmic strains, the pole of an inflated sheet.
#include <cmath>

#include <ceres/jet.h>
#include <gtest/gtest.h>

#include "softform/fitting/parameter_fit.hpp"
#include "softform/materials/hart_smith.hpp"
#include "softform/materials/ogden.hpp"
#include "support/finite_differences.hpp"
#include "support/materials.hpp"

namespace softform {
namespace {

using testing::check_slope;
using testing::energy;

const std::vector<Stretches> various{{1.0, 1.0}, {2.0, 1.0}, {1.5, 1.5}, {3.0, 1 / std::sqrt(3.0)},
                                     {0.6, 1.3}, {2.0, 1.7}};

class Homogeneous : public ::testing::TestWithParam<std::string> {
 protected:
  const Material& material() const { return *material_; }
  std::vector<double> values() const
  {
    std::vector<double> values;
    for (const MaterialParameter& parameter : material_->parameters()) values.push_back(parameter.value);
    return values;
  }

 private:
  std::unique_ptr<Material> material_ = testing::example_of(GetParam());
};

INSTANTIATE_TEST_SUITE_P(Registry, Homogeneous, ::testing::ValuesIn(testing::model_names()),
                         [](const auto& test) { return test.param; });

TEST_P(Homogeneous, StressIsTheSlopeOfTheEnergy)
{
  for (const Stretches& l : various) {
    const Eigen::Array2d P = nominal_stress(material(), l);
    for (const int i : {0, 1}) {
      const auto W = [this](const Vec& x) { return Vec::Constant(1, energy(material(), x[0], x[1])); };
      const auto check =
          check_slope(W, l.matrix(), Vec::Unit(2, i), Vec::Constant(1, P[i]), 1e-2, 1e-2 * material().shear_modulus());
      EXPECT_TRUE(check.passes()) << l.transpose() << ", direction " << i << ": " << check;
    }
  }
}

TEST_P(Homogeneous, UniaxialLeavesNothingAcross)
{
  // Uniaxial: the second stress vanishes by symmetry of the two lateral directions.
  for (const double stretch : {0.6, 1.5, 4.0})
    EXPECT_NEAR(nominal_stress(material(), stretches_of(TestMode::Uniaxial, stretch))[1], 0,
                1e-9 * std::abs(nominal_stress(material(), stretches_of(TestMode::Uniaxial, stretch))[0]));
}

TEST_P(Homogeneous, StressByParametersHasRightSlopes)
{
  const MaterialModel& model = find_material_model(GetParam());
  const std::vector<double> p = values();
  for (const Stretches& l : various) {
    const StressByParameters exact = stress_by_parameters(model, p, l);
    EXPECT_TRUE(exact.stress.isApprox(nominal_stress(material(), l), 1e-12) || exact.stress.matrix().norm() < 1e-6);
    for (std::size_t j = 0; j < p.size(); ++j) {
      const auto P = [&](const Vec& q) {
        std::vector<double> changed = p;
        changed[j] = q[0];
        return Vec(nominal_stress(model, changed, l).matrix());
      };
      const double size = std::max(std::abs(p[j]), 1e-2);
      const auto check = check_slope(P, Vec::Constant(1, p[j]), Vec::Constant(1, size),
                                     size * exact.by_parameters.col(Eigen::Index(j)).matrix(), 1e-2,
                                     1e-2 * material().shear_modulus());
      EXPECT_TRUE(check.passes()) << l.transpose() << ", parameter " << j << ": " << check;
    }
  }
}

TEST_P(Homogeneous, LogarithmicStiffnessIsTheSlopeOfKirchhoffStress)
{
  for (const Stretches& l : various) {
    const Eigen::Matrix2d H = logarithmic_stiffness(material(), l);
    EXPECT_NEAR(H(0, 1), H(1, 0), 1e-12 * H.norm());
    for (const int j : {0, 1}) {
      const auto tau = [&](const Vec& e) {
        const Stretches at = e.array().exp();
        return Vec((at * nominal_stress(material(), at)).matrix());
      };
      const auto check =
          check_slope(tau, l.log().matrix(), Vec::Unit(2, j), H.col(j), 1e-2, 1e-2 * material().shear_modulus());
      EXPECT_TRUE(check.passes()) << l.transpose() << ", direction " << j << ": " << check;
    }
  }
}

TEST_P(Homogeneous, PoleOfAnInflatedSheetIsEquibiaxial)
{
  for (const double stretch : {1.2, 2.5}) {
    const double thickness = 8e-4, radius = 0.02;
    const double pressure = pole_pressure(material(), thickness, radius, stretch);
    EXPECT_NEAR(pole_stress(pressure, thickness, radius, stretch) /
                    nominal_stress(material(), stretches_of(TestMode::Equibiaxial, stretch))[0],
                1, 1e-12);
    // p r/2 is the true stress times the thickness now, h/L^2.
    const double true_stress = stretch * nominal_stress(material(), {stretch, stretch})[0];
    EXPECT_NEAR(pressure * radius / 2, true_stress * thickness / (stretch * stretch), 1e-9 * std::abs(true_stress));
  }
}

TEST(ClosedForms, NeoHookeanAndMooneyRivlin)
{
  // P = (C1 + C2 L2^2) (L1 - L3^2/L1), with C1 = mu_1 and C2 = mu_2 (Treloar 1975, 10.8).
  const double mu_1 = 3e5, mu_2 = 4e4;
  const auto neo = make_material("neo_hookean", {{"mu", mu_1}});
  const auto mooney = make_material("mooney_rivlin", {{"mu_1", mu_1}, {"mu_2", mu_2}});
  for (const double L : {0.5, 1.1, 2.0, 5.0}) {
    const double uniaxial = L - 1 / (L * L), equibiaxial = L - std::pow(L, -5), shear = L - std::pow(L, -3);
    const auto stress = [L](const Material& material, TestMode mode) {
      return nominal_stress(material, stretches_of(mode, L))[0];
    };
    EXPECT_NEAR(stress(*neo, TestMode::Uniaxial), mu_1 * uniaxial, 1e-6);
    EXPECT_NEAR(stress(*neo, TestMode::Equibiaxial), mu_1 * equibiaxial, 1e-6);
    EXPECT_NEAR(stress(*neo, TestMode::PureShear), mu_1 * shear, 1e-6);
    EXPECT_NEAR(stress(*mooney, TestMode::Uniaxial), (mu_1 + mu_2 / L) * uniaxial, 1e-6);
    EXPECT_NEAR(stress(*mooney, TestMode::Equibiaxial), (mu_1 + mu_2 * L * L) * equibiaxial, 1e-6);
    EXPECT_NEAR(stress(*mooney, TestMode::PureShear), (mu_1 + mu_2) * shear, 1e-6);
  }
}

/// Dual numbers against Ceres' own on the formulas with the most in them.
template <template <class> class Model>
void expect_same_as_jets(const std::vector<double>& p, double t, double d)
{
  using Jet = ceres::Jet<double, 4>;
  std::vector<Jet> jets;
  std::vector<Dual> duals;
  for (std::size_t j = 0; j < p.size(); ++j) {
    jets.emplace_back(p[j], static_cast<int>(j));
    duals.push_back(Dual::variable(p[j], static_cast<int>(j)));
  }
  const auto ours = Model<Dual>::from(duals).density(t, d, Order::Gradient);
  const auto theirs = Model<Jet>::from(jets).density(t, d, Order::Gradient);
  for (int j = 0; j < static_cast<int>(p.size()); ++j) {
    EXPECT_NEAR(ours.psi.derivative(j), theirs.psi.v[j], 1e-12 * std::abs(theirs.psi.v[j])) << j;
    EXPECT_NEAR(ours.psi_t.derivative(j), theirs.psi_t.v[j], 1e-12 * std::abs(theirs.psi_t.v[j])) << j;
    EXPECT_NEAR(ours.psi_d.derivative(j), theirs.psi_d.v[j], 1e-12 * std::abs(theirs.psi_d.v[j])) << j;
  }
}

TEST(Dual, AgreesWithCeresJets)
{
  for (const auto& [t, d] : {std::pair(2.5, 1.2), {8.0, 15.9}, {20.0, 30.0}}) {
    expect_same_as_jets<HartSmith>({2e5, 0.03, 0.4}, t, d);
    expect_same_as_jets<Ogden>({3e5, 1.7, 2e4, -2.5}, t, d);
  }
}

}  // namespace
}  // namespace softform
