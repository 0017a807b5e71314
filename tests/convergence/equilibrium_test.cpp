// Static equilibria of balloons: found to round-off, with the right stability, or said not to be found.

#include "softform/core/parallel.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "softform/balloons/spherical_balloon.hpp"
#include "softform/equilibrium/newton_iteration.hpp"
#include "softform/mesh/shapes.hpp"
#include "support/deformations.hpp"
#include "support/test_balloon.hpp"

namespace softform::testing {
namespace {

constexpr double radius = 0.03;  // [m]
constexpr double peak_stretch = 1.3831;

// Lowered after every step; near the equilibrium dropped as soon as it sufficed at once.
TEST(TangentShift, IsLoweredAndDropped)
{
  const NewtonOptions options;
  TangentShift shift(options);
  EXPECT_EQ(shift.raise(), options.first_shift);
  shift.relax(1);
  EXPECT_DOUBLE_EQ(shift.value(), 0.2 * options.first_shift);
  shift.relax(1);
  EXPECT_DOUBLE_EQ(shift.value(), 0.04 * options.first_shift);
  shift.raise();
  shift.relax(1e-3);
  EXPECT_DOUBLE_EQ(shift.value(), 0.2 * options.first_shift);
  shift.relax(1e-3);
  EXPECT_EQ(shift.value(), 0);
}

class NeoHookeanSphere : public ::testing::Test {
 protected:
  double exact_pressure(double stretch) const
  {
    return spherical_balloon_pressure(*neo_hookean(), 3e-4, radius, stretch);
  }

  TestBalloon sphere{irregular_sphere(radius, 250), neo_hookean()};
};

TEST_F(NeoHookeanSphere, PrescribedPressureGivesAStableEquilibrium)
{
  const double pressure = 0.9 * exact_pressure(peak_stretch);
  const Equilibrium found =
      solve_at_pressure(sphere.balloon, pressure, 1.05 * sphere.balloon.rest_positions(), sphere.factorization);
  ASSERT_TRUE(found.report.converged()) << found.report.message;
  EXPECT_LT(found.residual, 1e-8);
  EXPECT_EQ(found.pressure, pressure);
  EXPECT_EQ(sphere.negative_eigenvalues(found.x, pressure), 0);
}

TEST_F(NeoHookeanSphere, FallingBranchIsStableAtFixedVolumeOnly)
{
  const Equilibrium found = sphere.at_stretch(1.8);
  ASSERT_TRUE(found.report.converged()) << found.report.message;
  EXPECT_LT(found.residual, 1e-8);
  EXPECT_EQ(found.negative_eigenvalues, 0);
  EXPECT_GT(sphere.negative_eigenvalues(found.x, found.pressure), 0);
}

TEST_F(NeoHookeanSphere, TangentOfThePathTurnsAtTheLimitPoint)
{
  for (const double stretch : {1.3, 1.5}) {
    Vec dx_dV;
    double dp_dV = 0;
    const double volume = sphere.balloon.rest_volume() * std::pow(stretch, 3);
    const Equilibrium found = solve_at_volume(sphere.balloon, volume, stretch * sphere.balloon.rest_positions(), 0,
                                              sphere.factorization, {}, {}, &dx_dV, &dp_dV);
    ASSERT_TRUE(found.report.converged()) << found.report.message;
    EXPECT_EQ(dp_dV > 0, stretch < peak_stretch) << dp_dV;
    Vec dV;
    sphere.balloon.volume().gradient(found.x, dV);
    EXPECT_NEAR(dV.dot(dx_dV), 1, 1e-6);
  }
}

TEST_F(NeoHookeanSphere, InflationReachesThePressure)
{
  // The last is borne in a narrow range of stretches around the limit point only.
  for (const double fraction : {0.3, 0.7, 0.95, 0.998}) {
    const double pressure = fraction * exact_pressure(peak_stretch);
    const Equilibrium found = inflate_to_pressure(sphere.balloon, pressure, sphere.factorization);
    ASSERT_TRUE(found.report.converged()) << fraction << ": " << found.report.message;
    EXPECT_EQ(found.pressure, pressure);
    EXPECT_LT(found.residual, 1e-8);
    EXPECT_EQ(sphere.negative_eigenvalues(found.x, pressure), 0);
    EXPECT_LT(sphere.balloon.volume().value(found.x), std::pow(peak_stretch, 3) * sphere.balloon.rest_volume());
  }
}

TEST_F(NeoHookeanSphere, UnreachablePressureIsInfeasibleAndLeavesAState)
{
  const double pressure = 1.2 * exact_pressure(peak_stretch);
  const Equilibrium found = inflate_to_pressure(sphere.balloon, pressure, sphere.factorization);
  EXPECT_EQ(found.report.termination, Termination::Infeasible) << found.report.message;
  ASSERT_EQ(found.x.size(), sphere.balloon.rest_positions().size());
  EXPECT_TRUE(found.x.allFinite());
  EXPECT_LT(found.pressure, pressure);
}

TEST_F(NeoHookeanSphere, ObserverInterruptsAnInflation)
{
  int steps = 0;
  const Equilibrium found = inflate_to_volume(sphere.balloon, 30 * sphere.balloon.rest_volume(), sphere.factorization,
                                              {}, {}, [&](const InflationStep&, const Vec&) { return ++steps < 2; });
  EXPECT_EQ(steps, 2);
  EXPECT_EQ(found.report.termination, Termination::Interrupted);
  EXPECT_TRUE(found.x.allFinite());
}

TEST_F(NeoHookeanSphere, HeldCoordinatesStayPut)
{
  FixedDofs fixed{Vec::Ones(sphere.balloon.rest_positions().size())};
  for (int i = 0; i < sphere.mesh.vertex_count(); ++i)
    if (sphere.mesh.vertices(i, 2) < -0.7 * radius) fixed.free.segment<3>(3 * i).setZero();
  ASSERT_LT(fixed.free.sum(), static_cast<double>(fixed.free.size()));

  const Equilibrium at_volume =
      inflate_to_volume(sphere.balloon, 3 * sphere.balloon.rest_volume(), sphere.factorization, {}, fixed);
  ASSERT_TRUE(at_volume.report.converged()) << at_volume.report.message;
  const Equilibrium at_pressure = solve_at_pressure(sphere.balloon, 0.5 * exact_pressure(peak_stretch),
                                                    sphere.balloon.rest_positions(), sphere.factorization, {}, fixed);
  ASSERT_TRUE(at_pressure.report.converged()) << at_pressure.report.message;
  for (const Equilibrium& found : {at_volume, at_pressure})
    EXPECT_EQ(((1 - fixed.free.array()) * (found.x - sphere.balloon.rest_positions()).array()).matrix().norm(), 0);
}

TEST(Newton, ConvergesQuadratically)
{
  TestBalloon bumps(bumpsphere(radius, 1000), silicone());
  const Equilibrium inflated = inflate_to_volume(bumps.balloon, 5 * bumps.balloon.rest_volume(), bumps.factorization);
  ASSERT_TRUE(inflated.report.converged()) << inflated.report.message;
  const Vec start = inflated.x + 1e-3 * radius * wiggle(static_cast<int>(inflated.x.size()), 3);
  const Equilibrium found = solve_at_pressure(bumps.balloon, inflated.pressure, start, bumps.factorization);
  ASSERT_TRUE(found.report.converged()) << found.report.message;

  // Near the solution every residual is of the order of the square of the one before, down to round-off.
  const auto& trace = found.report.trace;
  int quadratic_steps = 0;
  for (std::size_t k = 1; k < trace.size(); ++k) {
    const double before = trace[k - 1].stationarity, after = trace[k].stationarity;
    if (before > 0.01) continue;
    EXPECT_LT(after, std::max(5 * before * before, 1e-11)) << "after " << before;
    ++quadratic_steps;
  }
  EXPECT_GE(quadratic_steps, 2);
}

TEST(Newton, DoesNotDependOnTheNumberOfThreads)
{
  const auto inflated_with = [](int threads) {
    const int before = thread_count();
    set_thread_count(threads);
    TestBalloon bumps(bumpsphere(radius, 1000), silicone());
    Equilibrium found = inflate_to_volume(bumps.balloon, 6 * bumps.balloon.rest_volume(), bumps.factorization);
    set_thread_count(before);
    return found;
  };
  const Equilibrium one = inflated_with(1), two = inflated_with(2);
  ASSERT_TRUE(one.report.converged() && two.report.converged());
  EXPECT_EQ(one.iterations, two.iterations);
  EXPECT_LT((one.x - two.x).cwiseAbs().maxCoeff(), 1e-9 * radius);
  EXPECT_NEAR(one.pressure / two.pressure, 1, 1e-10);
}

TEST(Newton, NonFiniteStartIsReported)
{
  TestBalloon sphere(irregular_sphere(radius, 250), neo_hookean());
  Vec x = sphere.balloon.rest_positions();
  x[7] = std::nan("");
  EXPECT_EQ(solve_at_pressure(sphere.balloon, 100, x, sphere.factorization).report.termination, Termination::NotFinite);
  EXPECT_EQ(solve_at_volume(sphere.balloon, 1e-3, x, 100, sphere.factorization).report.termination,
            Termination::NotFinite);
  EXPECT_EQ(sphere.negative_eigenvalues(x, 100), -1);
}

// A spring whose energy and forces are finite and whose tangent is not: no shift makes it definite.
class SpringWithoutTangent : public Potential {
 public:
  double value(ConstVec x) const override { return 0.5 * x.squaredNorm(); }
  void gradient(ConstVec x, Vec& g) const override { g = x; }
  void hessian(ConstVec x, SparseMatrix& K) const override
  {
    K.resize(x.size(), x.size());
    K.setIdentity();
    K.coeffs().setConstant(std::nan(""));
  }
  double force_scale() const override { return 1; }
  double length_scale() const override { return 1; }
};

TEST(Newton, NonFiniteTangentIsReported)
{
  SparseFactorization factorization;
  const Equilibrium found = solve_equilibrium(SpringWithoutTangent(), Vec::Ones(3), factorization);
  EXPECT_EQ(found.report.termination, Termination::NotFinite);
  EXPECT_EQ(found.x, Vec::Ones(3));
}

}  // namespace
}  // namespace softform::testing
