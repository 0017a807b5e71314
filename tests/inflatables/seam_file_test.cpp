#include "softform/inflatables/seam_file.hpp"

#include <gtest/gtest.h>

#include "support/expect_input_error.hpp"
#include "support/temporary_folder.hpp"

namespace softform {
namespace {

TEST(SeamFile, HoldsSeamsWallsAndNames)
{
  const test::TemporaryFolder folder;
  const SeamPlan plan = read_seam_file(folder.write("seams.json", R"({
    "comment": "a comment",
    "seams": [{"name": "ring", "closed": true, "weight": 3, "points": [[0, 1, 2], [1, 1, 2], [0, 1, 3]]},
              {"name": "line", "points": [{"on": "ring", "at": 0.5}, [0, 0, 3], {"on": "ring", "near": [1, 1, 2]}]}],
    "walls": [{"name": "brace", "between": ["ring", "line"]}],
    "panels": [{"name": "head", "inside": [0, 2, 2]}]})"));
  ASSERT_EQ(plan.seams.size(), 2U);
  EXPECT_TRUE(plan.seams[0].is_closed);
  EXPECT_EQ(plan.seams[0].weight, 3);
  EXPECT_FALSE(plan.seams[1].is_closed);
  EXPECT_EQ(plan.seams[1].weight, 1);
  ASSERT_EQ(plan.seams[1].points.size(), 3U);
  EXPECT_EQ(plan.seams[1].points[0].on, "ring");
  EXPECT_EQ(plan.seams[1].points[0].fraction, 0.5);
  EXPECT_EQ(plan.seams[1].points[1].position, Vec3(0, 0, 3));
  EXPECT_FALSE(plan.seams[1].points[2].fraction.has_value());
  EXPECT_EQ(plan.walls[0].between[1], "line");
  EXPECT_EQ(plan.panels[0].inside, Vec3(0, 2, 2));
  const SeamPlan twice = scaled(plan, 2);
  EXPECT_EQ(twice.seams[1].points[2].position, Vec3(2, 2, 4));
  EXPECT_EQ(twice.panels[0].inside, Vec3(0, 4, 4));
}

TEST(SeamFile, WhatIsWrongIsNamedWithItsPlaceAndCure)
{
  const test::TemporaryFolder folder;
  const std::string ring = R"({"name": "ring", "points": [[0, 0, 0], [1, 0, 0]]})";
  const std::vector<std::pair<std::string, std::vector<std::string>>> bad_files{
      {"{\"seams\": [", {"line 1", "JSON", "correct"}},
      {"[]", {"object", "seams"}},
      {"{}", {"'seams' is missing"}},
      {R"({"seams": []})", {"no seam", "draw"}},
      {R"({"seams": [)" + ring + R"(], "colour": 1})", {"unknown key 'colour'", "walls"}},
      {R"({"seams": [{"name": "a"}]})", {"seam 1", "'points' is missing"}},
      {R"({"seams": [{"name": "a", "points": [[0, 0, 0]]}]})", {"seam 'a'", "1 points", "at least 2"}},
      {R"({"seams": [{"name": "a", "closed": true, "points": [[0, 0, 0], [1, 0, 0]]}]})", {"seam 'a'", "at least 3"}},
      {R"({"seams": [{"name": "a", "points": [[0, 0], [1, 0, 0]]}]})", {"seam 'a', point 1", "[x, y, z]"}},
      {R"({"seams": [{"name": "a", "points": [[0, "x", 0], [1, 0, 0]]}]})", {"seam 'a', point 1", "not a number"}},
      {R"({"seams": [{"name": "a", "weight": -1, "points": [[0, 0, 0], [1, 0, 0]]}]})", {"'weight'", "negative"}},
      {R"({"seams": [)" + ring + "," + ring + "]}", {"'ring'", "another seam has this name"}},
      {R"({"seams": [{"name": "a", "points": [{"on": "b", "at": 0}, [1, 0, 0]]}]})", {"'b'", "there is none"}},
      {R"({"seams": [)" + ring + R"(, {"name": "a", "points": [{"on": "rong", "at": 0}, [1, 0, 0]]}]})",
       {"'rong'", "there are ring"}},
      {R"({"seams": [)" + ring + R"(, {"name": "a", "points": [{"on": "ring", "at": 2}, [1, 0, 0]]}]})",
       {"point 1", "between 0 and 1"}},
      {R"({"seams": [)" + ring + R"(, {"name": "a", "points": [{"on": "ring"}, [1, 0, 0]]}]})", {"\"at\"", "\"near\""}},
      {R"({"seams": [)" + ring + R"(], "walls": [{"name": "w", "between": ["ring"]}]})", {"wall 1", "two seams"}},
      {R"({"seams": [)" + ring + R"(], "walls": [{"name": "w", "between": ["ring", "ring"]}]})", {"twice"}},
      {R"({"seams": [)" + ring + R"(], "panels": [{"name": "p"}]})", {"panel 1", "'inside' is missing"}},
  };
  for (const auto& [text, words] : bad_files) {
    SCOPED_TRACE(text);
    const auto file = folder.write("bad.json", text);
    std::vector<std::string> all = words;
    all.push_back(file.string());
    test::expect_input_error([&] { read_seam_file(file); }, all);
  }
  test::expect_input_error([&] { read_seam_file(folder / "none.json"); }, {"none.json"});
}

}  // namespace
}  // namespace softform
