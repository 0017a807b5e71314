#include "softform/characters/drawing.hpp"

#include <cmath>
#include <fstream>
#include <numbers>

#include <gtest/gtest.h>

#include "softform/mesh/triangulate.hpp"
#include "support/expect_input_error.hpp"
#include "support/temporary_folder.hpp"

namespace softform {
namespace {

// A bar from (0, 0) to (0, 100 mm) with one bone along it.
const char* const bar = R"({
  "description": "a bar", "unit": "mm",
  "outline": [{"mirror": true, "points": [[4, 0, "corner"], [4, 100, "corner"]]}],
  "bones": [{"name": "spine", "path": [[0, 0], [0, 100]]}],
  "poses": [{"name": "still", "bends": {}}, {"name": "arc", "bends": {"spine": 90}},
            {"name": "wave", "bends": {"spine": [60, -60]}}]
})";

struct Drawing : ::testing::Test {
  test::TemporaryFolder folder;

  CharacterDrawing read(const std::string& text)
  {
    std::ofstream(folder.path() / "figure.json") << text;
    return read_drawing(folder.path() / "figure.json");
  }

  // The bar with one part replaced.
  void refuses(const std::string& part, const std::string& by, const std::vector<std::string>& words)
  {
    std::string text = bar;
    text.replace(text.find(part), part.size(), by);
    std::vector<std::string> all{"figure.json"};
    all.insert(all.end(), words.begin(), words.end());
    test::expect_input_error([&] { make_character(read(text), 300); }, all);
  }
};

TEST_F(Drawing, bends_a_bar_into_an_arc)
{
  const PosedCharacter character = make_character(read(bar), 600);
  EXPECT_NEAR(character.rest.triangle_count(), 600, 12);
  EXPECT_LT((character.targets[0] - character.rest.vertices).norm(), 1e-14);
  // A centreline of length L that bends evenly by theta ends at L (1 - cos theta) / theta to the left and at
  // L sin(theta) / theta; the tip's points turn with it. The weights blend along about the bar's half-width.
  const double L = 0.1, theta = std::numbers::pi / 2;
  const Eigen::RowVector2d tip(-L * (1 - std::cos(theta)) / theta, L * std::sin(theta) / theta);
  for (int i = 0; i < character.rest.vertex_count(); ++i) {
    const Eigen::RowVector2d rest = character.rest.vertices.row(i);
    if (rest.y() < L - 1e-9) continue;
    const Eigen::RowVector2d expected = tip + rest.x() * Eigen::RowVector2d(std::cos(theta), std::sin(theta));
    EXPECT_LT((character.targets[1].row(i) - expected).norm(), 0.02 * L);
  }
}

TEST_F(Drawing, weights_are_a_partition_of_unity)
{
  const CharacterDrawing drawing = read(bar);
  const PlanarMesh mesh = triangulate_to_count(drawing.outline, 300);
  const Eigen::MatrixXd weights = link_weights(drawing.skeleton, mesh);
  EXPECT_GE(weights.minCoeff(), 0);
  EXPECT_LT((weights.rowwise().sum().array() - 1).abs().maxCoeff(), 1e-12);
}

TEST_F(Drawing, refuses_what_it_cannot_use)
{
  refuses("\"unit\": \"mm\"", "\"unit\": \"furlong\"", {"furlong"});
  refuses("\"unit\"", "\"units\"", {"'unit' is missing"});
  refuses("\"mirror\"", "\"mirrored\"", {"loop 0", "unknown key 'mirrored'"});
  refuses("[4, 0, \"corner\"]", "[4]", {"loop 0, point 0", "[x, y]"});
  refuses("[4, 0, \"corner\"]", "[4, 0, \"sharp\"]", {"loop 0, point 0", "corner"});
  refuses("[[0, 0], [0, 100]]", "[[0, 0]]", {"bone 'spine'", "two points"});
  refuses("\"name\": \"spine\"", "\"name\": \"spine\", \"parent\": \"hip\"", {"bone 'spine'", "hip"});
  refuses("{\"spine\": 90}", "{\"spine\": \"far\"}", {"pose 'arc'", "degrees"});
  refuses("}]\n}", "", {"no drawing"});
}

TEST_F(Drawing, names_the_pose_that_cannot_be)
{
  const auto make = [&](const char* by) {
    std::string text = bar;
    text.replace(text.find("{\"spine\": 90}"), 13, by);
    make_character(read(text), 600);
  };
  test::expect_input_error([&] { make("{\"tail\": 90}"); }, {"'tail'"});
  test::expect_input_error([&] { make("{\"spine\": 2000}"); }, {"pose 'arc'", "triangle"});
}

TEST(Drawings, of_the_thesis_have_its_sizes_and_demanding_poses)
{
  struct Case {
    const char* name;
    int triangles;
    double size;  // [m]
    int poses;
    double demand;  // in three poses some vertex moves this far [m]
  };
  for (const Case& c : {Case{"tour_eiffel", 525, 0.202, 5, 0.05}, Case{"palmy_2d", 2745, 0.1, 3, 0.025},
                        Case{"worm_eye", 808, 0.13, 4, 0.05}}) {
    const PosedCharacter character = make_character(
        read_drawing(std::string(SOFTFORM_TEST_DATASETS) + "/characters/" + c.name + ".json"), c.triangles);
    EXPECT_NEAR(character.rest.triangle_count(), c.triangles, 0.005 * c.triangles) << c.name;
    const Eigen::RowVector2d extent =
        character.rest.vertices.colwise().maxCoeff() - character.rest.vertices.colwise().minCoeff();
    EXPECT_NEAR(extent.maxCoeff(), c.size, 0.02 * c.size) << c.name;
    ASSERT_EQ(static_cast<int>(character.targets.size()), c.poses) << c.name;
    int demanding = 0;
    for (const PlanarPositions& target : character.targets)
      demanding += (target - character.rest.vertices).rowwise().norm().maxCoeff() > c.demand ? 1 : 0;
    EXPECT_GE(demanding, 3) << c.name;
  }
}

}  // namespace
}  // namespace softform
