#include "softform/mesh/implicit_model.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "softform/io/model_file.hpp"
#include "softform/mesh/check.hpp"
#include "softform/mesh/level_surface.hpp"
#include "support/expect_input_error.hpp"
#include "support/finite_differences.hpp"
#include "support/temporary_folder.hpp"

namespace softform {
namespace {

const Eigen::Matrix3d upright = Eigen::Matrix3d::Identity();
const Eigen::Matrix3d turned = Eigen::AngleAxisd(0.7, Vec3(1, 2, -1).normalized()).toRotationMatrix();

double distance(const Primitive& primitive, const Vec3& p) { return evaluate(primitive, p).value; }

TEST(RoundTube, of_one_ball_is_the_ball)
{
  const RoundTube ball({{{1, 2, 3}, 2}});
  EXPECT_NEAR(distance(ball, {1, 2, 8}), 3, 1e-14);
  EXPECT_NEAR(distance(ball, {2, 2, 3}), -1, 1e-14);
}

TEST(RoundTube, of_two_balls_is_the_nearest_of_all_balls_between_them)
{
  const Ball a{{0, 0, 0}, 2}, b{{1, 2, 4}, 0.8};
  const RoundTube cone({a, b});
  for (const Vec3& p : {Vec3(3, 0, 1), Vec3(0, 0, -3), Vec3(2, 3, 6), Vec3(0.3, 0.9, 1.2), Vec3(-2, 1, 3)}) {
    double nearest = 1e9;
    for (int i = 0; i <= 100'000; ++i) {
      const double u = i / 1e5;
      const double radius = (1 - u) * a.radius + u * b.radius;
      nearest = std::min(nearest, (p - (1 - u) * a.center - u * b.center).norm() - radius);
    }
    EXPECT_NEAR(distance(cone, p), nearest, 1e-8) << p.transpose();
  }
}

TEST(RoundTube, of_which_one_ball_holds_the_other_is_the_larger)
{
  const RoundTube cone({{{0, 0, 0}, 3}, {{1, 0, 0}, 1}});
  EXPECT_NEAR(distance(cone, {5, 0, 0}), 2, 1e-14);
}

TEST(RoundTube, passes_through_the_balls_given)
{
  const std::vector<Ball> given{{{0, 0, 0}, 1}, {{4, 0, 0}, 0.5}, {{4, 4, 0}, 0.7}};
  for (const Ball& ball : given) EXPECT_LE(distance(RoundTube(given), ball.center), -ball.radius + 1e-14);
}

TEST(Ellipsoid, is_exact_on_the_surface_and_for_a_ball)
{
  const Ellipsoid ellipsoid{{1, 0, 0}, {3, 2, 1}, turned};
  const Vec3 on_surface = ellipsoid.center + turned * Vec3(3, 2, 1).cwiseProduct(Vec3(1, -2, 2) / 3);
  EXPECT_NEAR(distance(ellipsoid, on_surface), 0, 1e-14);
  EXPECT_NEAR(evaluate(ellipsoid, on_surface).gradient.norm(), 1, 1e-12);
  EXPECT_NEAR(distance(Ellipsoid{{0, 0, 0}, {2, 2, 2}, upright}, {0, 3, 4}), 3, 1e-14);
  EXPECT_NEAR(distance(ellipsoid, ellipsoid.center), -1, 1e-14);
}

TEST(RoundedBox, is_the_distance_to_faces_edges_and_corners)
{
  const RoundedBox box{{0, 0, 0}, {3, 2, 1}, 0.5, upright};
  EXPECT_NEAR(distance(box, {0, 0, 4}), 3, 1e-14);
  EXPECT_NEAR(distance(box, {0, 0, 0.2}), -0.8, 1e-14);
  EXPECT_NEAR(distance(box, {2.5 + 3, 1.5 + 4, 0}), 5 - 0.5, 1e-14);
  EXPECT_NEAR(distance(box, {2.5 + 1, 1.5 + 2, 0.5 + 2}), 3 - 0.5, 1e-14);
  const RoundedBox moved{{1, 1, 1}, {3, 2, 1}, 0.5, turned};
  EXPECT_NEAR(distance(moved, Vec3(1, 1, 1) + turned * Vec3(0, 0, 4)), 3, 1e-14);
}

TEST(Torus, is_the_distance_to_the_ring)
{
  const Torus torus{{0, 0, 1}, {0, 0, 1}, 3, 0.5};
  EXPECT_NEAR(distance(torus, {3, 0, 1}), -0.5, 1e-14);
  EXPECT_NEAR(distance(torus, {0, 6, 5}), 4.5, 1e-14);
  EXPECT_NEAR(distance(torus, {0, 0, 1}), 2.5, 1e-14);
}

TEST(SmoothUnion, is_the_minimum_beyond_the_blend_and_deepest_where_both_are_equal)
{
  EXPECT_EQ(smooth_union({1, Vec3::UnitX()}, {4, Vec3::UnitY()}, 2).value, 1);
  EXPECT_EQ(smooth_union({4, Vec3::UnitX()}, {1, Vec3::UnitY()}, 2).gradient, Vec3(Vec3::UnitY()));
  EXPECT_EQ(smooth_union({1, Vec3::UnitX()}, {1, Vec3::UnitY()}, 2).value, 0.5);
  EXPECT_EQ(smooth_union({1, Vec3::UnitX()}, {1, Vec3::UnitY()}, 0).value, 1);
}

ImplicitModel every_kind_of_part()
{
  return {{{RoundTube({{{0, 0, 0}, 2}, {{0, 0, 3}, 1}, {{0, 1, 5}, 1}}), 0, false, false},
           {Ellipsoid{{1, 0, 2}, {2, 1, 1}, turned}, 1, true, false},
           {RoundedBox{{0, -2, 1}, {1, 1, 2}, 0.3, turned}, 0.8, false, false},
           {Torus{{0, 0, 3}, Vec3(1, 1, 0).normalized(), 1.5, 0.5}, 0.9, true, false},
           {RoundTube({{{1, 1, 4}, 1}}), 0.7, true, true}}};
}

TEST(ImplicitModel, has_the_gradient_of_its_value)
{
  const ImplicitModel model = every_kind_of_part();
  const auto value = [&](const Vec& p) -> Vec { return Vec::Constant(1, model.evaluate(p).value); };
  for (int i = 0; i < 40; ++i) {  // spread by the golden ratio and its square
    const Vec3 p(std::fmod(0.754878 * i, 1) * 6 - 3, std::fmod(0.569840 * i, 1) * 6 - 3, 0.2 * i - 2);
    for (int k = 0; k < 3; ++k) {
      const auto check =
          testing::check_slope(value, p, Vec3::Unit(k), Vec::Constant(1, model.evaluate(p).gradient[k]), 1e-3, 1e-2);
      EXPECT_TRUE(check.passes()) << p.transpose() << ": " << check;
    }
  }
}

TEST(ImplicitModel, mirrors_and_removes)
{
  const ImplicitModel two_balls{{{RoundTube({{{2, 0, 0}, 1}}), 0.5, true, false}}};
  EXPECT_EQ(two_balls.evaluate({-2, 0, 3}).value, two_balls.evaluate({2, 0, 3}).value);
  const ImplicitModel shell{
      {{RoundTube({{{0, 0, 0}, 3}}), 0, false, false}, {RoundTube({{{0, 0, 0}, 2}}), 0, false, true}}};
  EXPECT_NEAR(shell.evaluate({0, 0, 0}).value, 2, 1e-14);
  EXPECT_NEAR(shell.evaluate({0, 2.4, 0}).value, -0.4, 1e-14);
  EXPECT_NEAR(shell.evaluate({0, 0, 7}).value, 4, 1e-14);
}

TEST(MeshModel, of_a_capsule_has_its_volume_and_is_the_same_at_every_call)
{
  const ImplicitModel capsule{{{RoundTube({{{5, 0, -2}, 0.8}, {{5, 0, 2}, 0.8}}), 0, false, false}}};
  const TriangleMesh mesh = mesh_model(capsule, 700);
  for (int i = 0; i < mesh.vertex_count(); ++i) {
    const Vec3 p = mesh.vertices.row(i);
    ASSERT_NEAR((p - Vec3(5, 0, std::clamp(p.z(), -2.0, 2.0))).norm(), 0.8, 1e-12) << "vertex " << i;
  }
  const double volume = std::numbers::pi * (0.64 * 4 + 4.0 / 3 * 0.512);
  EXPECT_LT(enclosed_volume(mesh), volume);  // inscribed, under edges of a third of the radius
  EXPECT_GT(enclosed_volume(mesh), 0.97 * volume);

  const TriangleMesh again = mesh_model(capsule, 700);
  EXPECT_EQ(again.vertices, mesh.vertices);
  EXPECT_EQ(again.triangles, mesh.triangles);
}

TEST(LevelSurface, is_closed_faces_outwards_and_sees_one_component)
{
  const auto two_balls = [](const Vec3& p) { return std::min(p.norm() - 1, (p - Vec3(4, 0, 0)).norm() - 1); };
  double previous = 1;
  for (const double step : {0.2, 0.1, 0.05}) {
    const TriangleMesh mesh = level_surface(two_balls, {0.3, 0.1, 0.2}, step);
    const double error = std::abs(enclosed_volume(mesh) / (4 * std::numbers::pi / 3) - 1);
    EXPECT_LT(error, 0.4 * previous);  // second order
    previous = error;
    EXPECT_EQ(check_mesh(mesh).genus, 0);
    EXPECT_EQ(check_mesh(mesh).components, 1);
  }
  EXPECT_LT(previous, 2e-3);
  const auto ring = [](const Vec3& p) { return evaluate(Torus{{0, 0, 0}, {0, 0, 1}, 3, 1}, p).value; };
  EXPECT_EQ(check_mesh(level_surface(ring, {3, 0, 0}, 0.3)).genus, 1);
}

TEST(LevelSurface, refuses_a_start_outside_and_a_surface_without_end)
{
  test::expect_input_error([] { level_surface([](const Vec3&) { return 1.0; }, {0, 0, 0}, 1); }, {"not inside"});
  test::expect_input_error([] { level_surface([](const Vec3&) { return -1.0; }, {0, 0, 0}, 1); }, {"does not end"});
}

class OurModels : public ::testing::TestWithParam<std::pair<const char*, int>> {};

TEST_P(OurModels, mesh_into_closed_surfaces_of_the_count_asked_for)
{
  const auto [name, vertices] = GetParam();
  const ImplicitModel model = read_model(std::string(SOFTFORM_MODELS) + "/" + name + ".json");
  const TriangleMesh mesh = mesh_model(model, vertices);
  const MeshReport report = check_mesh(mesh);
  for (const MeshProblem& problem : report.problems) ADD_FAILURE() << problem.message;
  EXPECT_EQ(report.vertices, vertices);
  EXPECT_EQ(report.genus, 0);
  EXPECT_EQ(report.self_intersections, 0);
  EXPECT_GT(report.smallest_angle, 20);
  for (int i = 0; i < mesh.vertex_count(); ++i)
    ASSERT_NEAR(model.evaluate(mesh.vertices.row(i)).value, 0, 1e-9) << "vertex " << i;
}

INSTANTIATE_TEST_SUITE_P(All, OurModels,
                         ::testing::Values(std::pair{"gingerbread", 800}, std::pair{"mouse", 1000},
                                           std::pair{"squirrel", 1500}),
                         [](const auto& parameter) { return parameter.param.first; });

TEST(MeshModel, refuses_what_is_no_balloon)
{
  const ImplicitModel ring{{{Torus{{0, 0, 0}, {0, 0, 1}, 3, 1}, 0, false, false}}};
  test::expect_input_error([&] { mesh_model(ring, 500); }, {"genus 1", "ring"});
  const RoundTube ball({{{0, 0, 0}, 1}});
  test::expect_input_error([&] { mesh_model({{{ball, 0, false, false}, {ball, 0, false, true}}}, 500); }, {"empty"});
}

/// What is wrong with a model file: the text that one good line is replaced by, and words of the message.
struct Mistake {
  const char* parts;
  std::vector<std::string> words;
};

TEST(ModelFile, says_what_is_wrong_and_where)
{
  const test::TemporaryFolder folder;
  const Mistake mistakes[] = {
      {R"({"shape": "ellipsoid", "center": [0, 0, 0], "radius": [1, 1, 1]})", {"parts[0]", "'radius'", "radii"}},
      {R"({"shape": "ellipsoid", "center": [0, 0, 0]})", {"parts[0]", "'radii' is missing"}},
      {R"({"shape": "ellipsoid", "center": [0, 0], "radii": [1, 1, 1]})", {"parts[0]", "'center'", "3 numbers"}},
      {R"({"shape": "ellipsoid", "center": [0, 0, 0], "radii": [1, 0, 1]})", {"parts[0]", "'radii'", "positive"}},
      {R"({"shape": "tube", "balls": [[0, 0, 0, 1], [0, 0, 0, 2]]})", {"parts[0]", "same centre"}},
      {R"({"shape": "tube", "balls": [[0, 0, 0, -1]]})", {"parts[0]", "radius -1", "positive"}},
      {R"({"shape": "tube", "balls": []})", {"parts[0]", "'balls'", "not empty"}},
      {R"({"shape": "tube", "balls": [[0, 0, 0, 1]]}, {"shape": "cone"})", {"parts[1]", "'cone'", "tube, ellipsoid"}},
      {R"({"center": [0, 0, 0]})", {"parts[0]", "\"shape\""}},
      {R"({"shape": "tube", "balls": [[0, 0, 0, 1]], "mirror": 1})", {"parts[0]", "'mirror'", "true or false"}},
      {R"({"shape": "tube", "balls": [[0, 0, 0, 1]], "blend": -2})", {"parts[0]", "'blend' is -2", "negative"}},
      {R"({"shape": "box", "center": [0, 0, 0], "sizes": [4, 2, 2], "rounding": 1.5})", {"parts[0]", "'rounding'"}},
      {R"({"shape": "torus", "center": [0, 0, 0], "axis": [0, 0, 0], "radii": [2, 1]})", {"'axis'", "direction"}},
      {R"(7)", {"parts[0]", "object"}},
      {R"({)", {"not valid JSON", "correct it"}},
  };
  for (const Mistake& mistake : mistakes) {
    const auto file = folder.write("m.json", std::string(R"({"unit": "mm", "parts": [)") + mistake.parts + "]}");
    std::vector<std::string> words = mistake.words;
    words.emplace_back("m.json");
    test::expect_input_error([&] { read_model(file); }, words);
  }
  test::expect_input_error([&] { read_model(folder.write("n.json", R"({"parts": []})")); }, {"n.json", "'unit'"});
  test::expect_input_error([&] { read_model(folder.write("n.json", R"({"unit": "ell", "parts": []})")); },
                           {"ell", "mm"});
  test::expect_input_error([&] { read_model(folder.write("n.json", R"({"unit": "m", "parts": []})")); }, {"not empty"});
  test::expect_input_error([&] { read_model(folder.write("n.json", R"({"unit": "m", "part": []})")); }, {"'part'"});
  test::expect_input_error([&] { read_model(folder / "none.json"); }, {"none.json"});
}

TEST(ModelFile, takes_its_unit)
{
  const test::TemporaryFolder folder;
  const auto file = folder.write("m.json", R"({"unit": "cm", "blend": 1, "parts": [
    {"shape": "box", "center": [1, 0, 0], "sizes": [4, 2, 2], "turn": {"axis": [0, 0, 2], "angle": 90}}]})");
  const ImplicitModel model = read_model(file);
  EXPECT_NEAR(model.evaluate({0.01, 0.05, 0}).value, 0.03, 1e-15);
  EXPECT_EQ(model.parts.front().blend, 0.01);
}

}  // namespace
}  // namespace softform
