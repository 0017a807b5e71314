// Static equilibria of panels under pressure, against closed forms and the full energy.
#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "softform/balloons/spherical_balloon.hpp"
#include "softform/inflatables/inflatable.hpp"
#include "softform/inflatables/pillow.hpp"
#include "softform/materials/registry.hpp"
#include "softform/materials/tension_field.hpp"
#include "softform/mesh/shapes.hpp"
#include "support/deformations.hpp"
#include "support/expect_input_error.hpp"
#include "support/finite_differences.hpp"

namespace softform::testing {
namespace {

using softform::test::expect_input_error;

constexpr double kappa = 1e6, thickness = 1e-3;

// Two discs of radius 1 m, nearly inextensible: kappa h / (p a) = 1000. Paulsen 1994, The American Mathematical Monthly
// 101: the Mylar balloon's volume over the disc's radius cubed.
constexpr double mylar_volume = 1.218524;

Equilibrium inflate_disc(int spokes, int rings, double* volume)
{
  const PanelLayout layout = pillow(spoked_disc(1, spokes, rings));
  const Inflatable inflatable(layout, std::make_shared<TensionField>(kappa, 0, 1e-6), thickness, 1);
  SparseFactorization factorization;
  const Equilibrium equilibrium = inflate(inflatable, flat_vector(layout), flatten(layout.nodes), factorization);
  *volume = inflatable.volume().value(equilibrium.x);
  return equilibrium;
}

TEST(Inflation, MylarBalloonConvergesToItsVolume)
{
  double coarse = 0, fine = 0;
  const Equilibrium first = inflate_disc(24, 6, &coarse), second = inflate_disc(48, 12, &fine);
  EXPECT_TRUE(first.report.converged()) << first.report.message;
  EXPECT_TRUE(second.report.converged()) << second.report.message;
  EXPECT_LE(second.iterations, 60);
  const double error = std::abs(fine / mylar_volume - 1),
               order = std::log2(std::abs(coarse / mylar_volume - 1) / error);
  EXPECT_LT(error, 0.012);
  EXPECT_GT(order, 1.5);
}

// A sphere of its own triangles is taut everywhere: relaxed and full energy have the same equilibrium, and it follows
// the closed form, the residual stiffness adding 4 residual kappa h / (R L) to the pressure.
TEST(Inflation, TautSphereFollowsTheClosedForm)
{
  const double radius = 0.1, stretch = 1.2, residual = 0.05;
  const TriangleMesh mesh = sphere(radius, 1500);
  const PanelLayout layout = triangles_apart(mesh);
  const std::shared_ptr<const Material> full = make_material("neo_hookean", {{"mu", 2 * kappa}});
  const double pressure = spherical_balloon_pressure(*full, thickness, radius, stretch);
  const double bias = 4 * residual * kappa * thickness / (radius * stretch);
  const auto mean_radius = [&](std::shared_ptr<const Material> material, double p) {
    const Inflatable inflatable(layout, std::move(material), thickness, p);
    SparseFactorization factorization;
    const Equilibrium e = inflate(inflatable, flat_vector(layout), flatten(layout.nodes), factorization);
    EXPECT_TRUE(e.report.converged()) << e.report.message;
    EXPECT_EQ(inflatable.compression(e.x, flat_vector(layout)).maxCoeff(), 0);
    return std::cbrt(inflatable.volume().value(e.x) / enclosed_volume(mesh)) / stretch;
  };
  const double relaxed = mean_radius(std::make_shared<TensionField>(kappa), pressure);
  EXPECT_NEAR(relaxed, 1, 2e-3);
  EXPECT_NEAR(mean_radius(full, pressure), relaxed, 1e-8);  // what the forces are balanced to
  EXPECT_NEAR(mean_radius(std::make_shared<TensionField>(kappa, 0, residual), pressure + bias), relaxed, 1e-3);
}

// A square sheet's corner region wrinkles: shells of compression, none of it in the taut middle.
TEST(Inflation, PillowIsCompressedAtItsSeam)
{
  const PanelLayout layout = pillow(rectangle(1, 1, 12, 12));
  const Inflatable inflatable(layout, std::make_shared<TensionField>(kappa, 0, 1e-5), thickness, 5);
  SparseFactorization factorization;
  const Vec flat = flat_vector(layout);
  const Equilibrium e = inflate(inflatable, flat, flatten(layout.nodes), factorization);
  ASSERT_TRUE(e.report.converged()) << e.report.message;
  const Vec compression = inflatable.compression(e.x, flat);
  EXPECT_GT(compression.maxCoeff(), 0.05);
  EXPECT_LT(compression.minCoeff(), 1e-12);
  Vec g;
  inflatable.gradient(e.x, flat, g);
  EXPECT_LT(largest_nodal_norm(g), 1e-6 * inflatable.force_scale());
}

TEST(Inflation, WallIsSewnInAndHoldsTheSkinsTogether)
{
  const int columns = 16, rows = 8;
  const TriangleMesh sheet = rectangle(2, 1, columns, rows);
  std::vector<int> line;
  for (int j = 0; j <= rows; ++j) line.push_back(columns / 2 + (columns + 1) * j);
  const PanelLayout layout = pillow_with_wall(sheet, line, 0.15, 0.25);
  ASSERT_EQ(layout.panels.size(), 5U);
  EXPECT_TRUE(layout.panels.back().is_wall);
  const Inflatable inflatable(layout, std::make_shared<TensionField>(kappa, 0, 1e-5), thickness, 1);
  SparseFactorization factorization;
  const Vec flat = flat_vector(layout);
  const Equilibrium e = inflate(inflatable, flat, flatten(layout.nodes), factorization);
  ASSERT_TRUE(e.report.converged()) << e.report.message;
  const Positions x = unflatten(e.x);
  const int middle = line[std::size_t(rows / 2)];
  EXPECT_NEAR(2 * x(middle, 2), 0.15, 2e-3);
  EXPECT_GT(x(middle + columns / 4, 2), 0.2);  // the bellies left and right stand higher
}

// Round-off left 3e-6 of the pressure on the nodes of 59k nearly inextensible triangles, and 4e-9 on these few: the
// strains are as small as a ten thousandth.
// Newton's method crept along at the floor of round-off, 400 iterations for nothing.
TEST(Inflation, EndsWhereRoundOffLeavesTheForces)
{
  const PanelLayout layout = three_lune_sphere(1, 6);
  const Inflatable inflatable(layout, std::make_shared<TensionField>(kappa, 0, 1e-5), thickness, 1);
  SparseFactorization factorization;
  NewtonOptions options = inflation_options();
  options.tolerance = 1e-16;
  const Equilibrium e = inflate(inflatable, flat_vector(layout), flatten(layout.nodes), factorization, options);
  EXPECT_LT(e.residual, 1e-8);
  EXPECT_LT(e.iterations, 200);
}

TEST(Inflation, RoundOffLeavesFewForces)
{
  const PanelLayout layout = three_lune_sphere(1, 11);
  const Inflatable inflatable(layout, std::make_shared<TensionField>(kappa, 0, 1e-5), thickness, 1);
  SparseFactorization factorization;
  NewtonOptions options = inflation_options();
  options.tolerance = 3e-10;
  const Equilibrium e = inflate(inflatable, flat_vector(layout), flatten(layout.nodes), factorization, options);
  EXPECT_LE(e.residual, options.tolerance) << e.report.message;
}

// The energy under the pressure itself, which Newton's method minimises directly.
class TotalEnergy : public Potential {
 public:
  TotalEnergy(const Inflatable& inflatable, const Vec& flat) : inflatable_(inflatable), flat_(flat) {}

  double value(ConstVec x) const override { return inflatable_.value(x, flat_); }
  void gradient(ConstVec x, Vec& g) const override { inflatable_.gradient(x, flat_, g); }
  void hessian(ConstVec x, SparseMatrix& K) const override { inflatable_.hessian(x, flat_, K); }
  double force_scale() const override { return inflatable_.force_scale(); }
  double length_scale() const override { return inflatable_.length_scale(); }

 private:
  const Inflatable& inflatable_;
  const Vec& flat_;
};

// Stiff panels followed their narrow valley in 45 short steps; by way of an overpressure it takes some 26 to the same
// equilibrium.
TEST(Inflation, OverpressureShortensTheWayOfStiffPanels)
{
  const PanelLayout layout = three_lune_sphere(1, 11);
  const Inflatable inflatable(layout, std::make_shared<TensionField>(kappa, 0, 1e-5), thickness, 1);
  const Vec flat = flat_vector(layout), x0 = flatten(layout.nodes);
  SparseFactorization factorization;
  const Equilibrium direct = solve_equilibrium(TotalEnergy(inflatable, flat), x0, factorization, inflation_options());
  const Equilibrium e = inflate(inflatable, flat, x0, factorization);
  ASSERT_TRUE(direct.report.converged() && e.report.converged());
  EXPECT_LE(e.iterations, 0.75 * direct.iterations);
  EXPECT_LT((e.x - direct.x).lpNorm<Eigen::Infinity>(), 1e-6);  // rigid motions are held by the shift alone
  EXPECT_NEAR(inflatable.value(e.x, flat), inflatable.value(direct.x, flat), 1e-11);

  // An equilibrium is kept: no way round through the overpressure.
  EXPECT_LE(inflate(inflatable, flat, e.x, factorization).iterations, 1);
}

// The full energy folds into wrinkles as fine as the mesh, and is above its lower bound, the relaxed energy, by what
// folds of that size cannot give way. On a fine mesh Newton's method with shifts alone was left with 120 times the
// pressure on a node.
TEST(Inflation, FullEnergyIsBalancedInItsWrinkles)
{
  const PanelLayout layout = pillow(rectangle(1, 1, 16, 16));
  const Vec flat = flat_vector(layout);
  const Inflatable relaxed(layout, std::make_shared<TensionField>(kappa, 0, 1e-6), thickness, 1);
  const Inflatable full(layout, make_material("neo_hookean", {{"mu", 2 * kappa}}), thickness, 1);
  SparseFactorization factorization;
  const Equilibrium start = inflate(relaxed, flat, flatten(layout.nodes), factorization);
  ASSERT_TRUE(start.report.converged()) << start.report.message;
  const Vec disturbed = start.x + 1e-3 * wiggle(3 * layout.node_count(), 2);
  for (const Equilibrium& e :
       {inflate(full, flat, disturbed, factorization), settle(full, flat, disturbed, factorization)}) {
    EXPECT_TRUE(e.report.converged()) << e.report.message;
    EXPECT_LE(e.residual, 1e-6);
    const double ratio = full.value(e.x, flat) / relaxed.value(start.x, flat);  // of negative energies
    EXPECT_LT(ratio, 1);
    EXPECT_GT(ratio, 0.85);
    SparseMatrix K;
    full.hessian(e.x, flat, K);
    EXPECT_EQ(count_negative_eigenvalues(K, factorization), 0);
  }
}

// E = W - p V with a wall, all derivatives at a shape in no equilibrium; the smoothed energy is smooth enough.
TEST(Inflation, EnergyHasTheRightSlopes)
{
  const TriangleMesh sheet = rectangle(2, 1, 4, 2);
  const PanelLayout layout = pillow_with_wall(sheet, {2, 7, 12}, 0.3, 0.5);
  const Inflatable E(layout, std::make_shared<TensionField>(kappa, 0.1, 1e-3), thickness, 700);
  const Vec X = flat_vector(layout);
  const Vec x = 1.3 * flatten(layout.nodes) + 0.02 * wiggle(3 * layout.node_count(), 2);
  const Vec d = wiggle(int(x.size()), 3), lambda = wiggle(int(x.size()), 5), D = wiggle(int(X.size()), 4);
  const auto forces = [&](const Vec& y) -> Vec {
    Vec g;
    E.gradient(y, X, g);
    return g;
  };
  SparseMatrix K, xx, mixed, XX;
  E.hessian(x, X, K);
  E.force_hessian(x, X, lambda, xx, mixed, XX);
  const double step = 1e-5;
  EXPECT_SLOPE(check_slope([&](const Vec& y) { return Vec::Constant(1, E.value(y, X)); }, x, d,
                           Vec::Constant(1, forces(x).dot(d)), step));
  EXPECT_SLOPE(check_slope(forces, x, d, K * d, step));
  const auto lambda_K = [&](const Vec& y, const Vec& Y) -> Vec {
    SparseMatrix H;
    E.hessian(y, Y, H);
    return H * lambda;
  };
  EXPECT_SLOPE(check_slope([&](const Vec& y) { return lambda_K(y, X); }, x, d, xx * d, step));
  EXPECT_SLOPE(check_slope([&](const Vec& Y) { return lambda_K(x, Y); }, X, D, mixed * D, step));
}

TEST(Inflation, RefusesWhatCannotBeInflated)
{
  PanelLayout layout = pillow(rectangle(1, 1, 2, 2));
  const auto material = std::make_shared<TensionField>(kappa);
  expect_input_error([&] { Inflatable(layout, material, thickness, -1); }, {"pressure", "positive"});
  expect_input_error([&] { Inflatable(layout, material, 0, 1); }, {"thickness"});
  layout.panels[1].is_wall = true;
  expect_input_error([&] { Inflatable(layout, material, thickness, 1); }, {"open", "edge", "sew"});
  TriangleMesh ring = rectangle(1, 1, 3, 3);
  const Triangles all = ring.triangles;
  ring.triangles.resize(all.rows() - 2, 3);
  ring.triangles << all.topRows(8), all.bottomRows(8);  // the middle cell is cut out
  expect_input_error([&] { pillow(ring); }, {"holes"});
  expect_input_error([&] { pillow_with_wall(rectangle(1, 1, 2, 2), {1, 4, 7}, 0, 0.1); }, {"wall"});
}

}  // namespace
}  // namespace softform::testing
