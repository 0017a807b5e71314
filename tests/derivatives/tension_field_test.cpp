// The relaxed energy (6.6): derivatives in every branch and transition, continuity across them, appendix B.
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "softform/fem/membrane.hpp"
#include "softform/materials/registry.hpp"
#include "softform/materials/tension_field.hpp"
#include "softform/materials/wrinkle_smoothing.hpp"
#include "support/deformations.hpp"
#include "support/expect_input_error.hpp"
#include "support/finite_differences.hpp"
#include "support/material_slopes.hpp"

namespace softform::testing {
namespace {

using softform::test::expect_input_error;

constexpr double kappa = 2e5, residual = 1e-3;

struct Branch {
  std::string name;
  double smoothing, lambda_1, lambda_2;
};

// With smoothing 0.2 the transitions reach to s = 1 + 0.2 (lambda_1 - lambda_2) and to
// lambda_2 = 1/s + 0.2 (lambda_1 - lambda_2).
const std::vector<Branch> branches{
    {"Slack", 0, 0.8, 0.5},
    {"Wrinkled", 0, 1.5, 0.4},
    {"WrinkledFlat", 0, 1.5, 1e-3},
    {"Taut", 0, 1.5, 1.1},
    {"SlackToWrinkled", 0.2, 1.08, 0.5},
    {"SmoothedWrinkled", 0.2, 2.2, 0.5},
    {"WrinkledToTaut", 0.2, 2.2, 0.8},
    {"SlackToTaut", 0.2, 1.15, 0.96},
    {"SmoothedTaut", 0.2, 1.5, 1.2},
};

double trace(const Branch& b) { return b.lambda_1 + b.lambda_2; }
double determinant(const Branch& b) { return b.lambda_1 * b.lambda_2; }

class TensionFieldBranches : public ::testing::TestWithParam<Branch> {};

TEST_P(TensionFieldBranches, DensityHasTheRightSlopes)
{
  const Branch& b = GetParam();
  const TensionField material(kappa, b.smoothing, residual);
  expect_density_slopes(material, trace(b), determinant(b));
  expect_same_density_of_strain(material, trace(b), determinant(b));
}

// The stress of nearly inextensible panels is a difference of stiffnesses. From t and d it was lost in round-off:
// a strain of 1e-9 left no digit of it, and large meshes could not be balanced.
TEST(TensionFieldPrecision, TinyStrainsKeepTheirDigits)
{
  const TensionField material(kappa);
  for (const double strain : {1e-3, 1e-6, 1e-9, 1e-12}) {
    const double strain_2 = -3 * strain;  // wrinkled: below 1/s - 1
    const MembraneDensity f = material.density_of_strain({2, 1, strain + strain_2, strain * strain_2}, Order::Hessian);
    // psi'(lambda_1) and psi''(lambda_1) of the wrinkled branch, lambda_1 the larger root of (lambda - 1)^2 - a (lambda
    // - 1) + e.
    const double stress = -kappa * std::expm1(-1.5 * std::log1p(strain));
    const double modulus = 1.5 * kappa * std::pow(1 + strain, -2.5);
    const double by_a = strain / (strain - strain_2), by_e = -1 / (strain - strain_2);
    const double by_ee = -2 / std::pow(strain - strain_2, 3);
    EXPECT_NEAR(f.psi_t / (stress * by_a), 1, 1e-12) << strain;
    EXPECT_NEAR(f.psi_d / (stress * by_e), 1, 1e-12) << strain;
    EXPECT_NEAR(f.psi_dd / (modulus * by_e * by_e + stress * by_ee), 1, 1e-11) << strain;
  }
}

TEST_P(TensionFieldBranches, ParametersHaveTheRightSlopes)
{
  const Branch& b = GetParam();
  const auto material = [](const Vec& v) { return TensionField(v[0], v[1], v[2]); };
  expect_parameter_slopes(material, Vec3(kappa, std::max(b.smoothing, 0.1), residual), trace(b), determinant(b));
}

TEST_P(TensionFieldBranches, PanelsHaveTheRightSlopes)
{
  const Branch& b = GetParam();
  expect_panel_slopes(std::make_shared<TensionField>(kappa, b.smoothing, residual), b.lambda_1, b.lambda_2);
}

INSTANTIATE_TEST_SUITE_P(Branches, TensionFieldBranches, ::testing::ValuesIn(branches),
                         [](const auto& branch) { return branch.param.name; });

TEST(TensionField, IsNeoHookeanWhereTautAndItsMinimumWhereWrinkled)
{
  const TensionField relaxed(kappa);
  const auto full = make_material("neo_hookean", {{"mu", 2 * kappa}});
  const double taut_t = 1.5 + 1.1, taut_d = 1.5 * 1.1;
  EXPECT_NEAR(relaxed.density(taut_t, taut_d, Order::Value).psi, full->density(taut_t, taut_d, Order::Value).psi,
              1e-12 * kappa);
  // (6.5) by search: the least full energy over lambda_2 at lambda_1 = 1.5.
  double least = 1e300;
  for (double lambda_2 = 0.5; lambda_2 < 1.2; lambda_2 += 1e-5)
    least = std::min(least, full->density(1.5 + lambda_2, 1.5 * lambda_2, Order::Value).psi);
  EXPECT_NEAR(relaxed.density(1.5 + 0.3, 1.5 * 0.3, Order::Value).psi, least, 1e-9 * kappa);
  EXPECT_EQ(relaxed.density(0.9 + 0.3, 0.9 * 0.3, Order::Value).psi, 0);
  EXPECT_EQ(tension_state(0.9 + 0.3, 0.9 * 0.3), TensionState::Slack);
  EXPECT_EQ(tension_state(1.5 + 0.3, 1.5 * 0.3), TensionState::Wrinkled);
  EXPECT_EQ(tension_state(taut_t, taut_d), TensionState::Taut);
}

TEST(TensionField, NotANumberStaysNotANumber)
{
  EXPECT_TRUE(std::isnan(TensionField(kappa).density(NAN, 1, Order::Value).psi));
  EXPECT_TRUE(std::isnan(TensionField(kappa).density(2, NAN, Order::Value).psi));
}

TEST(TensionField, RefusesBadParameters)
{
  expect_input_error([] { TensionField(-1); }, {"kappa"});
  expect_input_error([] { TensionField(1, -0.1); }, {"smoothing"});
  expect_input_error([] { TensionField(1, 0, NAN); }, {"residual"});
}

// The two lines of (6.4), crossed along lambda_1 and along lambda_2.
struct Crossing {
  double lambda_1, lambda_2;
  Eigen::Vector2d direction;
};
const std::vector<Crossing> crossings{
    {1, 0.6, {1, 0}}, {1.6, 1 / std::sqrt(1.6), {1, 0}}, {1.6, 1 / std::sqrt(1.6), {0, 1}}};

// Second derivatives in t and d on both sides of a line: their largest difference at a distance.
double jump(const TensionField& material, const Crossing& c, double distance)
{
  const auto second = [&](double side) {
    const Eigen::Vector2d l = Eigen::Vector2d(c.lambda_1, c.lambda_2) + side * distance * c.direction;
    return hessian_of(material.density(l.sum(), l.prod(), Order::Hessian));
  };
  return (second(1) - second(-1)).lpNorm<Eigen::Infinity>() / material.kappa();
}

TEST(TensionField, SecondDerivativesJumpAndSmoothingMendsThem)
{
  for (const Crossing& c : crossings) {
    EXPECT_GT(jump(TensionField(kappa), c, 1e-7), 0.1);
    const TensionField smoothed(kappa, 0.1);
    // Both ends of the transition: where it starts, the line itself, and where it ends.
    EXPECT_LT(jump(smoothed, c, 1e-7), 1e-3);
    EXPECT_LT(jump(smoothed, c, 1e-8), 0.2 * jump(smoothed, c, 1e-7));
  }
}

// (6.8): values and slopes at both ends, through the intervals of (6.13), by differences from the two sides.
TEST(WrinkleSmoothing, JoinsTheDerivativesWithoutKinks)
{
  constexpr double delta = 0.2, h = 1e-6;
  const auto by_1 = [](double l_1) { return thesis_smoothed_derivatives(kappa, delta, l_1, 0.7).by_1 / kappa; };
  const auto by_2 = [](double l_2) { return thesis_smoothed_derivatives(kappa, delta, 1.6, l_2).by_2 / kappa; };
  const auto kink = [&](const auto& f, double x) { return (f(x + h) - f(x)) / h - (f(x) - f(x - h)) / h; };
  const TransitionInterval a = slack_to_wrinkled(kappa, delta, 0.7), b = wrinkled_to_taut_by_1(kappa, delta, 0.7),
                           c = wrinkled_to_taut_by_2(kappa, delta, 1.6);
  ASSERT_LT(a.u, b.start());
  for (const double x : {a.start(), a.u, b.start(), b.u}) EXPECT_LT(std::abs(kink(by_1, x)), 1e-4) << x;
  for (const double x : {c.start(), c.u}) EXPECT_LT(std::abs(kink(by_2, x)), 1e-4) << x;
  // The kinks that were there: 1.5 kappa, and those of the taut branch's second derivatives.
  const auto raw_1 = [](double l_1) { return relaxed_derivatives(kappa, l_1, 0.7).by_1 / kappa; };
  EXPECT_NEAR(kink(raw_1, 1), 1.5, 1e-4);
  EXPECT_NEAR(kink(raw_1, 1 / 0.49), 0.5 * std::pow(0.7, 5), 1e-4);
}

TEST(WrinkleSmoothing, OfTheThesisHasNoEnergy)
{
  constexpr double h = 1e-5, delta = 0.2;
  const auto curl = [&](const auto& psi, double l_1, double l_2) {
    return ((psi(l_1, l_2 + h).by_1 - psi(l_1, l_2 - h).by_1) - (psi(l_1 + h, l_2).by_2 - psi(l_1 - h, l_2).by_2)) /
           (2 * h * kappa);
  };
  const auto thesis = [](double l_1, double l_2) { return thesis_smoothed_derivatives(kappa, delta, l_1, l_2); };
  const auto exact = [](double l_1, double l_2) { return relaxed_derivatives(kappa, l_1, l_2); };
  const double inside = slack_to_wrinkled(kappa, delta, 0.5).intersection();
  EXPECT_GT(std::abs(curl(thesis, inside, 0.5)), 0.01);
  EXPECT_LT(std::abs(curl(exact, inside, 0.5)), 1e-8);
  EXPECT_LT(std::abs(curl(thesis, 1.5, 1.2)), 1e-8);
}

// Appendix B with its corrections, on one triangle: x (9), rest edges U, V.
struct AppendixB {
  Eigen::Vector2d lambda;
  Eigen::Matrix<double, 9, 2> first;
  Eigen::Matrix<double, 9, 9> second_1, second_2;

  AppendixB(const Vec& x, const Vec& flat)
  {
    Eigen::Matrix2d rest;
    rest << flat.segment<2>(2) - flat.head<2>(), flat.segment<2>(4) - flat.head<2>();
    const auto F_of = [&](const Vec& y) -> Eigen::Matrix<double, 3, 2> {
      Eigen::Matrix<double, 3, 2> edges;
      edges << y.segment<3>(3) - y.head<3>(), y.segment<3>(6) - y.head<3>();
      return edges * rest.inverse();
    };
    const Eigen::Matrix<double, 3, 2> F = F_of(x);
    const Eigen::Matrix2d C = F.transpose() * F;
    const double alpha = 0.5 * std::atan2(2 * C(0, 1), C(0, 0) - C(1, 1));
    const Eigen::Vector2d N_1(std::cos(alpha), std::sin(alpha)), N_2(-std::sin(alpha), std::cos(alpha));
    lambda << N_1.dot(C * N_1), N_2.dot(C * N_2);  // (B.1)
    const double difference = lambda[0] - lambda[1];
    for (int a = 0; a < 9; ++a) {
      const Eigen::Matrix<double, 3, 2> F_a = F_of(Vec::Unit(9, a));
      const Eigen::Matrix2d C_a = F_a.transpose() * F + F.transpose() * F_a;
      first.row(a) << N_1.dot(C_a * N_1), N_2.dot(C_a * N_2);  // (B.9)
      const double alpha_a = N_2.dot(C_a * N_1) / difference;  // (B.19)
      for (int b = 0; b < 9; ++b) {
        const Eigen::Matrix<double, 3, 2> F_b = F_of(Vec::Unit(9, b));
        const Eigen::Matrix2d C_b = F_b.transpose() * F + F.transpose() * F_b;
        const Eigen::Matrix2d C_ab = F_a.transpose() * F_b + F_b.transpose() * F_a;
        const double turn = 2 * difference * alpha_a * N_2.dot(C_b * N_1) / difference;
        second_1(a, b) = N_1.dot(C_ab * N_1) + turn;  // (B.18)
        second_2(a, b) = N_2.dot(C_ab * N_2) - turn;
      }
    }
  }
};

TEST(AppendixB, StretchesHaveTheirDerivatives)
{
  Vec flat(6), x(9);
  flat << 0, 0, 1, 0.1, 0.3, 0.8;
  x << 0, 0, 0, 1.2, 0.2, 0.1, 0.3, 0.3, 0.4;
  const AppendixB B(x, flat);
  ASSERT_GT(B.lambda[0], B.lambda[1]);
  const Vec direction = wiggle(9, 7);
  EXPECT_SLOPE(check_slope([&](const Vec& y) -> Vec { return AppendixB(y, flat).lambda; }, x, direction,
                           B.first.transpose() * direction, 1e-3));
  EXPECT_SLOPE(check_slope([&](const Vec& y) -> Vec { return AppendixB(y, flat).first.col(0); }, x, direction,
                           B.second_1* direction, 1e-3));
  EXPECT_SLOPE(check_slope([&](const Vec& y) -> Vec { return AppendixB(y, flat).first.col(1); }, x, direction,
                           B.second_2* direction, 1e-3));
}

// The wrinkled energy of (6.6) through appendix B is what the element computes through its dot products.
TEST(AppendixB, GivesTheElementsForcesAndStiffness)
{
  Vec flat(6), x(9);
  flat << 0, 0, 1, 0.1, 0.3, 0.8;
  x << 0, 0, 0, 1.2, 0.2, 0.1, 0.3, 0.3, 0.4;
  Triangles triangle(1, 3);
  triangle << 0, 1, 2;
  const PanelMembrane W(triangle, 3, triangle, 3, std::make_shared<TensionField>(kappa), Vec::Constant(1, 1e-3));
  const AppendixB B(x, flat);
  ASSERT_EQ(tension_state(B.lambda.sum(), B.lambda.prod()), TensionState::Wrinkled);
  const double volume = 1e-3 * FlatTriangleEdges(flat, 0, 1, 2).products().area(), lambda = B.lambda[0];
  const double psi_1 = kappa * (1 - std::pow(lambda, -1.5)), psi_11 = 1.5 * kappa * std::pow(lambda, -2.5);
  const Eigen::MatrixXd stiffness =
      volume * (psi_11 * B.first.col(0) * B.first.col(0).transpose() + psi_1 * B.second_1);
  Vec g;
  SparseMatrix K;
  W.gradient(x, flat, g);
  W.hessian(x, flat, K);
  EXPECT_LT((g - volume * psi_1 * B.first.col(0)).norm(), 1e-12 * g.norm());
  EXPECT_LT((Eigen::MatrixXd(K) - stiffness).norm(), 1e-12 * stiffness.norm());
}

}  // namespace
}  // namespace softform::testing
