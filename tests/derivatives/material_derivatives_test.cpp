// The derivatives of every material by finite differences, and the values against the formulas of appendix A.
#include <cmath>

#include <gtest/gtest.h>

#include "softform/materials/hart_smith.hpp"
#include "softform/materials/ogden.hpp"
#include "support/finite_differences.hpp"
#include "support/materials.hpp"

namespace softform {
namespace {

using testing::check_slope;
using testing::Side;
using Stretches = std::pair<double, double>;

/// Density entry number i in the order psi; t, d; tt, td, dd; ttt, ttd, tdd, ddd.
double entry(const MembraneDensity& w, int i)
{
  const double entries[] = {w.psi,    w.psi_t,   w.psi_d,   w.psi_tt,  w.psi_td,
                            w.psi_dd, w.psi_ttt, w.psi_ttd, w.psi_tdd, w.psi_ddd};
  return entries[i];
}

/// Every derivative up to the third as the slope of the one before, in t and in d. Where both stretches are equal the
/// domain lies to one side: larger t, smaller d.
void expect_right_slopes(const Material& material, Stretches stretches, double first_step = 1e-2)
{
  struct Slope {
    int function, in_t, in_d;
  };
  constexpr Slope slopes[] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}, {3, 6, 7}, {4, 7, 8}, {5, 8, 9}};
  const auto [l1, l2] = stretches;
  const Vec x{{l1 * l1 + l2 * l2, l1 * l1 * l2 * l2}};
  const bool at_edge = std::abs(l1 - l2) < 0.2;
  const MembraneDensity exact = material.density(x[0], x[1], Order::Third);
  ASSERT_TRUE(std::isfinite(exact.psi));

  for (const auto& [function, in_t, in_d] : slopes) {
    const auto f = [&material, i = function](const Vec& y) {
      return Vec::Constant(1, entry(material.density(y[0], y[1], Order::Hessian), i));
    };
    for (const int k : {0, 1}) {
      const double length = k == 0 ? x[0] : -x[1];
      const Vec direction = length * Vec::Unit(2, k);
      const Vec derivative = Vec::Constant(1, length * entry(exact, k == 0 ? in_t : in_d));
      const double scale = 1e-3 * std::abs(f(x)[0]) + 1e-9 * material.shear_modulus();
      const auto check =
          check_slope(f, x, direction, derivative, first_step, scale, at_edge ? Side::Forward : Side::Both);
      EXPECT_TRUE(check.passes()) << material.model() << " at stretches " << l1 << ", " << l2 << ", slope of entry "
                                  << function << (k == 0 ? " in t: " : " in d: ") << check;
    }
  }
}

class MaterialDerivatives : public ::testing::TestWithParam<std::string> {
 protected:
  const Material& material() const { return *material_; }

 private:
  std::unique_ptr<Material> material_ = testing::example_of(GetParam());
};

INSTANTIATE_TEST_SUITE_P(Registry, MaterialDerivatives, ::testing::ValuesIn(testing::model_names()),
                         [](const auto& test) { return test.param; });

TEST_P(MaterialDerivatives, StretchesApart)
{
  for (const Stretches& s : {Stretches(1.5, 1.1), {3.0, 1.2}, {0.9, 0.6}, {1.6, 0.5}})
    expect_right_slopes(material(), s);
}

TEST_P(MaterialDerivatives, StretchesNearlyEqual)
{
  for (const Stretches& s : {Stretches(1.1, 1.0), {1.0001, 1.0}, {2.0000001, 2.0}})
    expect_right_slopes(material(), s, 1e-3);
}

TEST_P(MaterialDerivatives, StretchesEqual)
{
  for (const Stretches& s : {Stretches(1.0, 1.0), {2.0, 2.0}, {0.7, 0.7}}) expect_right_slopes(material(), s, 1e-3);
}

TEST(HartSmith, SlopesOnBothBranchesOfTheExponentialIntegral)
{
  const auto material = make_material("hart_smith", {{"G", 1e5}, {"k1", 0.05}, {"k2", 0.3}});
  for (const Stretches& s : {Stretches(1.05, 1.3), {4.0, 3.0}, {5.0, 3.5}, {7.0, 6.0}})  // k1 (I1 - 3)^2 up to 330
    expect_right_slopes(*material, s, 1e-3);
}

TEST(HartSmith, SlopesWithoutTheExponential)
{
  const auto material = make_material("hart_smith", {{"G", 1e5}, {"k1", 0.0}, {"k2", 0.3}});
  expect_right_slopes(*material, {2.0, 1.4});
}

/// Integral of exp(k s^2) over s = 0 ... x by Simpson's rule.
long double integral_of_exponential(long double k, long double x)
{
  constexpr int n = 100000;
  long double sum = 0;
  for (int i = 0; i <= n; ++i) {
    const long double s = x * i / n;
    sum += (i == 0 || i == n ? 1 : (i % 2 ? 4 : 2)) * std::exp(k * s * s);
  }
  return sum * x / (3 * n);
}

TEST(HartSmith, EnergyIsTheQuadratureOfItsDerivative)
{
  for (const double k : {0.0, 1e-6, 0.0219, 0.5}) {
    for (const double x : {-1e-12, 1e-9, 0.1, 3.0, 8.9, 9.0, 20.0, 35.0}) {
      const double quadrature = static_cast<double>(integral_of_exponential(k, x));
      EXPECT_NEAR(exponential_integral_of_square(k, x) / quadrature, 1, k * x * x > 100 ? 1e-9 : 1e-12)
          << k << " " << x;
    }
  }
}

TEST(HartSmith, BranchesOfTheExponentialIntegralMeet)
{
  const double x = std::sqrt(40.0), step = 1e-13;
  const double below = exponential_integral_of_square(1 - step, x), above = exponential_integral_of_square(1 + step, x);
  EXPECT_NE(below, above);
  EXPECT_NEAR(above / below, 1, 80 * 2 * step);
}

TEST(Ogden, ChebyshevFunctionIsExactOnBothBranches)
{
  for (const double y : {0.0, 1e-12, 1e-6, 0.002, 0.00293, 0.00295, 0.0399, 0.0401, 0.3, 2.0, 50.0}) {
    const double c = 1 + y;
    {  // T_4 = 8 c^4 - 8 c^2 + 1
      const auto [T, T_1, T_2, T_3] = chebyshev_function(4.0, c);
      EXPECT_NEAR(T / (8 * c * c * (c * c - 1) + 1), 1, 1e-12) << y;
      EXPECT_NEAR(T_1 / (16 * c * (2 * c * c - 1)), 1, 1e-12) << y;
      EXPECT_NEAR(T_2 / (96 * c * c - 16), 1, 1e-12) << y;
      EXPECT_NEAR(T_3 / (192 * c), 1, 1e-11) << y;
    }
    {  // T_1/2 = sqrt((1 + c)/2)
      const auto [T, T_1, T_2, T_3] = chebyshev_function(0.5, c);
      const double root = std::sqrt((1 + c) / 2);
      EXPECT_NEAR(T / root, 1, 1e-12) << y;
      EXPECT_NEAR(T_1 * 4 * root, 1, 1e-12) << y;
      EXPECT_NEAR(T_2 * -16 * std::pow(root, 3), 1, 1e-11) << y;
      EXPECT_NEAR(T_3 * 64 / 3 * std::pow(root, 5), 1, 1e-10) << y;
    }
  }
}

/// The formulas of appendix A with J = 1, written in the principal stretches as printed.
long double appendix_a(const Material& material, long double l1, long double l2)
{
  const long double l3 = 1 / (l1 * l2), a = l1 * l1, b = l2 * l2, c = l3 * l3;
  const long double I1 = a + b + c, I2 = a * b + b * c + c * a;
  std::vector<long double> p;
  for (const MaterialParameter& parameter : material.parameters()) p.push_back(parameter.value);
  if (material.model() == "st_venant_kirchhoff") {
    const long double E1 = (a - 1) / 2, E2 = (b - 1) / 2, E3 = (c - 1) / 2, trace = E1 + E2 + E3;
    return p[0] / 2 * trace * trace + p[1] * (E1 * E1 + E2 * E2 + E3 * E3);
  }
  if (material.model() == "neo_hookean") return p[0] / 2 * (I1 - 3);
  if (material.model() == "mooney_rivlin") return p[0] / 2 * (I1 - 3) + p[1] / 2 * (I2 - 3);
  if (material.model() == "ogden") {
    long double W = 0;
    for (std::size_t j = 0; j + 1 < p.size(); j += 2)
      W += 2 * p[j] / (p[j + 1] * p[j + 1]) *
           (std::pow(l1, p[j + 1]) + std::pow(l2, p[j + 1]) + std::pow(l3, p[j + 1]) - 3);
    return W;
  }
  if (material.model() == "hart_smith") {
    return p[0] * integral_of_exponential(p[1], I1 - 3) + p[0] * p[2] * std::log(I2 / 3);
  }
  ADD_FAILURE() << "no formula here for " << material.model();
  return 0;
}

TEST_P(MaterialDerivatives, ValueIsThatOfAppendixA)
{
  for (const auto& [l1, l2] : {Stretches(1.0, 1.0), {1.5, 1.5}, {1.2, 1.1999999}, {1.3, 1.0}, {4.0, 0.7}, {5.0, 5.0}}) {
    const double W = static_cast<double>(appendix_a(material(), l1, l2));
    EXPECT_NEAR(testing::energy(material(), l1, l2), W, 1e-12 * (std::abs(W) + material().shear_modulus()));
  }
}

/// W1 = dPsi/dI1 and W2 = dPsi/dI2 of thesis A.3 to A.5 and A.7.
std::pair<double, double> invariant_derivatives(const Material& material, double I1, double I2)
{
  std::vector<double> p;
  for (const MaterialParameter& parameter : material.parameters()) p.push_back(parameter.value);
  if (material.model() == "st_venant_kirchhoff") return {p[0] * (I1 - 3) / 4 + p[1] * (I1 - 1) / 2, -p[1] / 2};
  if (material.model() == "neo_hookean") return {p[0] / 2, 0};
  if (material.model() == "mooney_rivlin") return {p[0] / 2, p[1] / 2};
  return {p[0] * std::exp(p[1] * (I1 - 3) * (I1 - 3)), p[0] * p[2] / I2};
}

TEST(SphericalBalloon, PressureOfTheEnergyIsTheClosedForm)
{
  // Radius R, thickness h, stretch L: p dV = dW gives p = h/(R L^2) dW/dL, and in the invariants
  // p = 4 (h/R) (1/L - 1/L^7) (W1 + L^2 W2).
  for (const std::string name : {"st_venant_kirchhoff", "neo_hookean", "mooney_rivlin", "hart_smith"}) {
    const auto material = testing::example_of(name);
    for (const double L : {0.9, 1.0, 1.2, 2.0, 3.0}) {
      const MembraneDensity w = material->density(2 * L * L, std::pow(L, 4), Order::Gradient);
      const double dW = 4 * L * w.psi_t + 4 * L * L * L * w.psi_d;
      const auto [W1, W2] = invariant_derivatives(*material, 2 * L * L + std::pow(L, -4), std::pow(L, 4) + 2 / (L * L));
      const double closed_form = 4 * (1 / L - std::pow(L, -7)) * (W1 + L * L * W2);
      EXPECT_NEAR(dW / (L * L), closed_form, 1e-12 * (material->shear_modulus() + std::abs(closed_form)))
          << name << " " << L;
    }
  }
}

}  // namespace
}  // namespace softform
