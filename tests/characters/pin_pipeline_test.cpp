// Stage 3 with pins whose positions are free, and the whole pipeline, on a small bar: derivatives by convergence slope,
// crisp layouts that are true equilibria, coordinates that are held, and input that is named.

#include <algorithm>
#include <array>

#include <gtest/gtest.h>

#include "softform/characters/pin_characters.hpp"
#include "softform/inverse/material_program.hpp"
#include "support/deformations.hpp"
#include "support/expect_input_error.hpp"
#include "support/finite_differences.hpp"

namespace softform::testing {
namespace {

Vec number(double value) { return Vec::Constant(1, value); }

// A bar of 60 x 12 mm with its left end at the origin.
class PinnedBar : public ::testing::Test {
 protected:
  static constexpr double length = 0.06, height = 0.012;

  PlanarMesh mesh = grid<2>({length, height}, {15, 3});
  PlanarSolid body = make_sheet(mesh);
  MaterialWeights weights{0.3, 0.2, 0.1, 1e-3, 0};

  Vec bent(double angle, double begin, double end) const { return arched(mesh, height, angle, begin, end); }

  // Bent into an arc by `angle` over the part of its length between `begin` and `end` alone.
  static Vec arched(const PlanarMesh& mesh, double height, double angle, double begin, double end)
  {
    Vec x = mesh.positions;
    for (int i = 0; i < mesh.vertex_count(); ++i) {
      const double s = mesh.positions[2 * i], y = mesh.positions[2 * i + 1] - height / 2;
      const double radius = (end - begin) / angle, turned = std::clamp((s - begin) / (end - begin), 0.0, 1.0) * angle;
      Point<2> axis(std::min(s, begin) + radius * std::sin(turned), radius * (1 - std::cos(turned)));
      axis += std::max(0.0, s - end) * Point<2>(std::cos(turned), std::sin(turned));
      x.segment<2>(2 * i) = axis + y * Point<2>(-std::sin(turned), std::cos(turned));
      x[2 * i + 1] += height / 2;
    }
    return x;
  }
  std::vector<Vec> targets() const { return {bent(0.6, 0.02, 0.03), bent(-0.5, 0.02, 0.03)}; }

  FixedDofs left_end() const
  {
    FixedDofs held{Vec::Ones(mesh.positions.size())};
    for (int i = 0; i < mesh.vertex_count(); ++i)
      if (mesh.positions[2 * i] < 1e-9) held.free.segment<2>(2 * i).setZero();
    return held;
  }

  // Two pins at the far end and in the middle, away from where they would be best.
  std::vector<MaterialPose<2>> poses(bool are_pins_free) const
  {
    const Pins pins{{{0.058, height}, {0.04, 0}},
                    {{0, 1}, {0, -1}},
                    {{{0.053, 0.025}, {0.037, 0.006}}, {{0.056, 0.002}, {0.038, -0.006}}}};
    std::vector<MaterialPose<2>> poses;
    for (std::size_t i = 0; i < 2; ++i)
      poses.push_back(
          {targets()[i], mesh.positions, left_end(), {}, pins_of_pose(body, pins, i, 5e4), {}, are_pins_free});
    return poses;
  }
};

TEST_F(PinnedBar, GradientsByDensitiesAndByPins)
{
  MaterialDesign<2> design(body, poses(false)), free(body, poses(true));
  const Vec rho = Vec::LinSpaced(body.element_count(), 0.2, 0.8);
  const auto state = design.start(rho).value();
  ASSERT_TRUE(design.linearize(state, weights));
  Vec g;
  design.gradient(g);
  const Vec d = wiggle(static_cast<int>(rho.size()), 3);
  const auto f = [&](const MaterialDesign<2>::State& from) {
    return number(design.objective(design.restart(from, from.rho).value(), weights));
  };
  const auto by_densities = [&](const Vec& r) {
    MaterialDesign<2>::State from = state;
    from.rho = r;
    return f(from);
  };
  EXPECT_SLOPE(check_slope(by_densities, rho, d, number(g.dot(d)), 0.02));
  ASSERT_TRUE(free.linearize(state, weights));
  const Vec e = wiggle(4, 5);
  for (std::size_t pose = 0; pose < 2; ++pose) {
    const auto by_pins = [&](const Vec& y) {
      MaterialDesign<2>::State from = state;
      from.pins[pose] = y;
      return f(from);
    };
    EXPECT_SLOPE(check_slope(by_pins, state.pins[pose], e, number(free.pin_gradient(pose).dot(e)), 1e-3));
  }
}

// What remains of the model for rho is that of the best pins: its gradient is that of min_y f(rho, y).
TEST_F(PinnedBar, GradientWithPinsThatFollow)
{
  MaterialDesign<2> design(body, poses(true), {100, 0.05});
  const auto best = [&](const Vec& rho) {
    MaterialDesign<2>::State state = design.start(rho).value();
    for (int k = 0; k < 40; ++k) {
      if (!design.linearize(state, weights) || design.pin_decrease() < 1e-15) break;
      state = design.move(state, rho, design.predict(Vec::Zero(rho.size()))).value();
    }
    return state;
  };
  const Vec rho = Vec::LinSpaced(body.element_count(), 0.2, 0.8), d = wiggle(static_cast<int>(rho.size()), 3);
  const auto state = best(rho);
  ASSERT_TRUE(design.linearize(state, weights));
  EXPECT_LT(design.pin_decrease(), 1e-12 * design.objective(state, weights));
  Vec g;
  design.gradient(g);
  EXPECT_SLOPE(check_slope([&](const Vec& r) { return number(design.objective(best(r), weights)); }, rho, d,
                           number(g.dot(d)), 0.04));
  // Damped pins follow less.
  const Vec followed = design.predict(d).pins[0];
  design.damp_pins(1e6);
  EXPECT_LT(design.predict(d).pins[0].norm(), 1e-3 * followed.norm());
}

TEST_F(PinnedBar, AProgrammeOfDensitiesAloneRefusesFreePins)
{
  MaterialDesign<2> design(body, poses(true));
  const auto first = design.start(Vec::Constant(body.element_count(), 0.5)).value();
  test::expect_input_error([&] { material_program<2>(design, first, weights); }, {"pins"});
}

TEST_F(PinnedBar, HeldCoordinatesHaveExactDerivatives)
{
  const auto check = [&](const NonlinearProgram& program, bool has_hessian) {
    const Vec z = program.initial_point() + 0.02 * wiggle(program.variable_count(), 7),
              direction = 0.1 * wiggle(program.variable_count(), 3);
    SparseMatrix J, H;
    program.constraint_jacobian(z, J);
    const auto constraints = [&](const Vec& y) {
      Vec c;
      program.constraints(y, c);
      return c;
    };
    EXPECT_SLOPE(check_slope(constraints, z, direction, J * direction, 1e-1, 1e-3));
    if (!has_hessian) return;
    const Vec lambda = wiggle(program.constraint_count(), 5);
    ASSERT_TRUE(program.lagrangian_hessian(z, lambda, H));
    const auto gradient = [&](const Vec& y) {
      Vec at_y;
      SparseMatrix jacobian;
      program.objective_gradient(y, at_y);
      program.constraint_jacobian(y, jacobian);
      return Vec(at_y + jacobian.transpose() * lambda);
    };
    EXPECT_SLOPE(check_slope(gradient, z, direction, H * direction, 1e-1, 1e-3));
  };
  check(SparseActuationProgram(body, targets(), {5, 20, 60}, {0, 4, 1}, left_end()), true);
  const Pins pins{{{0.058, height}}, {{0, 1}}, {{{0.053, 0.025}}, {{0.056, 0.002}}}};
  check(PinPlacementProgram(body, Vec::Zero(body.element_count()), targets(), pins, targets(), {}, left_end()), false);
}

TEST_F(PinnedBar, EveryStageBringsThePosesNearer)
{
  PinPipelineOptions options;
  options.actuators = {2, 2};
  options.held = left_end();
  options.first_traced_stage = 1;
  int reports = 0;
  const std::vector<PinStage> stages =
      run_pin_pipeline(body, targets(), options, [&](const PipelineProgress&) { return ++reports > 0; });
  ASSERT_EQ(stages.size(), 3U);
  EXPECT_GT(reports, 3);
  double previous = 1;
  for (const PinStage& stage : stages) {
    EXPECT_TRUE(stage.report.converged()) << stage.number << stage.report.message;
    EXPECT_TRUE(stage.is_sound()) << stage.number;
    EXPECT_EQ(stage.pins.count(), 2);
    EXPECT_LT(stage.mean_error(), previous) << stage.number;
    previous = stage.mean_error();
    for (std::size_t i = 0; i < 2; ++i) {
      const Vec held = (1 - options.held.free.array()).matrix();
      EXPECT_LT(held.cwiseProduct(stage.positions[i] - mesh.positions).lpNorm<Eigen::Infinity>(), 1e-9);
      EXPECT_TRUE(stage.traces[i].is_reached) << stage.number;
      EXPECT_LT((stage.traces[i].x - stage.positions[i]).lpNorm<Eigen::Infinity>(), 1e-6) << stage.number;
    }
  }
  const Vec& rho = stages.back().densities;
  for (Eigen::Index e = 0; e < rho.size(); ++e) EXPECT_TRUE(rho[e] == 0 || rho[e] == 1) << e;
  EXPECT_GT(rho.mean(), 0.05);
  EXPECT_LT(rho.mean(), 0.95);
  EXPECT_LT(3 * stages[2].mean_error(), stages[1].mean_error());
}

// With the equilibria as a penalty every step on a limp body was refused: places stayed where they were.
TEST_F(PinnedBar, PlacesMoveOnALimpBodyThatNothingHolds)
{
  constexpr double thin = 0.004;
  const PlanarMesh strip = grid<2>({0.12, thin}, {60, 2});
  const PlanarSolid limp = make_sheet(strip);
  const std::vector<Vec> poses{arched(strip, thin, 0.8, 0.03, 0.09), arched(strip, thin, -0.6, 0.03, 0.09)};
  const std::array vertices{10, 152, 50};  // below, above, below
  Pins pins{{}, {{0, -1}, {0, 1}, {0, -1}}, {}};
  for (const int i : vertices) pins.places.emplace_back(strip.positions.segment<2>(2 * i));
  for (const Vec& x : poses) {
    auto& held = pins.positions.emplace_back();
    for (const int i : vertices) held.emplace_back(x.segment<2>(2 * i));
  }
  PinPlacementOptions options;
  const auto squares = [&](int rounds) {
    options.rounds = rounds;
    const PinPlacement placed = place_pins(limp, Vec::Zero(limp.element_count()), poses, pins, poses, options);
    EXPECT_TRUE(placed.is_settled);
    EXPECT_EQ(placed.negative_eigenvalues, 0);
    return (placed.positions[0] - poses[0]).squaredNorm() + (placed.positions[1] - poses[1]).squaredNorm();
  };
  EXPECT_LT(4 * squares(5), squares(0));
}

TEST_F(PinnedBar, AStoppedPipelineSaysSo)
{
  PinPipelineOptions options;
  options.actuators = {2, 2};
  options.held = left_end();
  const std::vector<PinStage> stages =
      run_pin_pipeline(body, targets(), options, [](const PipelineProgress& progress) { return progress.stage < 2; });
  ASSERT_EQ(stages.size(), 2U);
  EXPECT_EQ(stages[0].report.termination, Termination::Converged);
  EXPECT_EQ(stages[1].report.termination, Termination::Interrupted);
  EXPECT_TRUE(stages[1].is_sound());
}

TEST_F(PinnedBar, InputThatCannotBeUsedIsNamed)
{
  const auto expect = [&](const std::vector<Vec>& poses, const PinPipelineOptions& options,
                          const std::vector<std::string>& words) {
    test::expect_input_error([&] { run_pin_pipeline(body, poses, options); }, words);
  };
  PinPipelineOptions options;
  expect({}, options, {"a pose"});
  expect({mesh.positions, Vec::Zero(4)}, options, {"pose 1", "vertices"});
  expect({-mesh.positions.reverse()}, options, {"pose 0", "element"});
  options.last_stage = 4;
  expect(targets(), options, {"stage 4"});
  options = {};
  options.actuators = {5, 4};
  expect(targets(), options, {"5 to 4 actuators"});
  options = {};
  options.held = left_end();
  options.vertices = {0};
  expect(targets(), options, {"vertex 0", "held"});
  const std::vector<int> boundary = boundary_vertices<2>(mesh.elements);
  options.vertices = {0};
  while (std::find(boundary.begin(), boundary.end(), options.vertices[0]) != boundary.end()) ++options.vertices[0];
  expect(targets(), options, {"boundary"});
}

}  // namespace
}  // namespace softform::testing
