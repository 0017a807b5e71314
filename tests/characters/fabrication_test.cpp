// From a layout to what is made: closed surfaces that fill the body, islands, plates to be drilled.

#include <cmath>
#include <regex>
#include <sstream>

#include <gtest/gtest.h>

#include "softform/characters/drill_plan.hpp"
#include "softform/characters/printed_body.hpp"
#include "softform/io/mesh_io.hpp"
#include "softform/io/text_file.hpp"
#include "softform/mesh/check.hpp"
#include "softform/mesh/solids.hpp"
#include "support/expect_input_error.hpp"
#include "support/solids.hpp"
#include "support/temporary_folder.hpp"

namespace softform::testing {
namespace {

// What keeps a surface from being printed; parts that do not hang together are no obstacle.
std::vector<std::string> problems(const TriangleMesh& mesh, bool may_touch_itself = false)
{
  std::vector<std::string> found;
  for (const MeshProblem& problem : check_mesh(mesh).problems)
    if (problem.kind != MeshProblemKind::SeveralComponents &&
        !(may_touch_itself && problem.kind == MeshProblemKind::SelfIntersection))
      found.push_back(problem.message);
  return found;
}

std::vector<bool> chosen(const SimplexMesh<3>& mesh, const std::function<bool(const Vec3&)>& is_inside)
{
  std::vector<bool> result;
  for (int e = 0; e < mesh.element_count(); ++e) {
    Vec3 centre = Vec3::Zero();
    for (const int i : mesh.elements.row(e)) centre += mesh.positions.segment<3>(3 * i) / 4;
    result.push_back(is_inside(centre));
  }
  return result;
}

ContactOptions in_place()
{
  ContactOptions options;
  options.gap = 0;
  return options;
}

// A pseudo-random number in [0, 1) for every index, the same everywhere.
double scatter(int i) { return std::fmod(std::abs(std::sin(12.9898 * i + 78.233)) * 43758.5453, 1.0); }

TEST(RegionSurface, CubesThatTouchInAnEdgeComeApart)
{
  const SimplexMesh<3> body = grid<3>({0.02, 0.02, 0.01}, {2, 2, 1});
  const auto diagonal = chosen(body, [](const Vec3& p) { return (p.x() < 0.01) == (p.y() < 0.01); });
  const RegionSurface exact = region_surface(body, diagonal, in_place());
  EXPECT_EQ(exact.split_vertices, 2);
  EXPECT_EQ(exact.split_edges, 0);
  EXPECT_EQ(parts_of(exact.mesh).size(), 2U);
  EXPECT_NEAR(enclosed_volume(exact.mesh), 2e-6, 1e-18);
  const RegionSurface apart = region_surface(body, diagonal);
  EXPECT_TRUE(problems(apart.mesh).empty()) << problems(apart.mesh).front();
  EXPECT_LT(enclosed_volume(apart.mesh), 2e-6);
  EXPECT_NEAR(enclosed_volume(apart.mesh) / 2e-6, 1, 1e-3);
}

TEST(RegionSurface, CubesThatTouchInACornerComeApart)
{
  const SimplexMesh<3> body = grid<3>({0.02, 0.02, 0.02}, {2, 2, 2});
  const auto corners = chosen(body, [](const Vec3& p) { return (p.array() < 0.01).all() || (p.array() > 0.01).all(); });
  const RegionSurface apart = region_surface(body, corners);
  EXPECT_EQ(apart.split_vertices, 1);
  EXPECT_EQ(parts_of(apart.mesh).size(), 2U);
  EXPECT_TRUE(problems(apart.mesh).empty());
}

// Two hollows that touch in a point: the region around them is one part, its surface has two copies of the point.
TEST(RegionSurface, HollowsThatTouchInACornerComeApart)
{
  const SimplexMesh<3> body = grid<3>({0.04, 0.04, 0.04}, {4, 4, 4});
  const auto is_hollow = [](const Vec3& p, double from) {
    return (p.array() > from).all() && (p.array() < from + 0.01).all();
  };
  const auto around = chosen(body, [&](const Vec3& p) { return !is_hollow(p, 0.01) && !is_hollow(p, 0.02); });
  const RegionSurface surface = region_surface(body, around);
  EXPECT_EQ(surface.split_vertices, 1);
  EXPECT_EQ(parts_of(surface.mesh).size(), 3U);
  EXPECT_TRUE(problems(surface.mesh).empty());
  EXPECT_NEAR(enclosed_volume(surface.mesh) / (64e-6 - 2e-6), 1, 1e-4);
}

// A ring of cubes that closes in an edge only: both ends of the edge keep one copy, the edge gets two.
TEST(RegionSurface, ARingThatClosesInAnEdgeIsOpened)
{
  const SimplexMesh<3> body = grid<3>({0.03, 0.03, 0.03}, {3, 3, 3});
  const auto ring = chosen(body, [](const Vec3& p) {
    const int x = int(p.x() / 0.01), y = int(p.y() / 0.01), z = int(p.z() / 0.01);
    // In the middle layer all cubes around the edge between (0, 0) and (1, 1) but for (0, 1) and (1, 0), which are
    // bridged above and below.
    if (z != 1) return x < 2 && y < 2;
    return (x == 0 && y == 0) || (x == 1 && y == 1);
  });
  const RegionSurface exact = region_surface(body, ring, in_place());
  EXPECT_EQ(exact.split_edges, 1);
  EXPECT_TRUE(problems(exact.mesh, true).empty());
  EXPECT_NEAR(enclosed_volume(exact.mesh), 10e-6, 1e-17);
  const RegionSurface apart = region_surface(body, ring);
  EXPECT_TRUE(problems(apart.mesh).empty()) << problems(apart.mesh).front();
}

TEST(PrintedBody, OfScatteredTetrahedraIsClosedAndFillsTheBody)
{
  const SimplexMesh<3> body = uneven_block<3>(0.02, 5);
  Vec densities(body.element_count());
  for (int e = 0; e < densities.size(); ++e) densities[e] = scatter(e) < 0.4 ? 1 : 0;
  PrintOptions options;
  options.contacts.gap = 0;
  const PrintedBody exact = printed_body(body, densities, options);
  ASSERT_EQ(exact.materials.size(), 2U);
  for (const PrintedMaterial& material : exact.materials) {
    EXPECT_TRUE(problems(material.surface.mesh, true).empty()) << problems(material.surface.mesh, true).front();
    EXPECT_GT(material.surface.split_vertices, 100);
  }
  EXPECT_GT(exact.materials[0].surface.split_edges, 0);
  EXPECT_NEAR((exact.materials[0].volume + exact.materials[1].volume) / exact.volume, 1, 1e-12);
  EXPECT_NEAR(exact.volume, 8e-6, 1e-12);
  double of_islands = 0;
  for (const Island& island : exact.islands) of_islands += island.volume;
  EXPECT_NEAR(of_islands / exact.volume, 1, 1e-12);
}

// Blobs as layouts have them, with ragged edges: all contacts come apart.
TEST(PrintedBody, OfBlobsOfTetrahedraCanBePrinted)
{
  const SimplexMesh<3> body = uneven_block<3>(0.02, 8);
  PrintOptions options;
  for (int phase = 0; phase < 3; ++phase) {
    Vec densities(body.element_count());
    for (int e = 0; e < densities.size(); ++e) {
      Vec3 centre = Vec3::Zero();
      for (const int i : body.elements.row(e)) centre += body.positions.segment<3>(3 * i) / 4;
      const Eigen::Array3d wave = (900 * centre.array() + phase).sin();
      densities[e] = wave.sum() + 0.3 * scatter(e) > 0.4 ? 1 : 0;
    }
    const PrintedBody printed = printed_body(body, densities, options);
    ASSERT_EQ(printed.materials.size(), 2U);
    for (const PrintedMaterial& material : printed.materials) {
      EXPECT_GT(material.surface.split_vertices, 0);
      EXPECT_TRUE(material.problems.empty()) << phase << ": " << material.problems.front();
    }
    // A gap of 10 um at some vertices, of edges of 2.5 mm.
    EXPECT_NEAR((printed.materials[0].volume + printed.materials[1].volume) / printed.volume, 1, 1e-3);
  }
}

TEST(PrintedBody, OfAPlateIsClosedFlatAndReadsBack)
{
  const test::TemporaryFolder folder;
  const SimplexMesh<2> plate = uneven_block<2>(0.05, 8);
  Vec densities(plate.element_count());
  for (int e = 0; e < densities.size(); ++e) densities[e] = scatter(e) < 0.5 ? 1 : 0;
  PrintOptions options;
  options.thickness = 0.01;
  const PrintedBody body = printed_body(plate, densities, options);
  EXPECT_NEAR(body.volume, 0.05 * 0.05 * 0.01, 1e-15);
  write_printed_body(folder.path(), body, true, options);
  double volume = 0;
  for (const PrintedMaterial& material : body.materials) {
    EXPECT_TRUE(material.problems.empty()) << material.problems.front();
    const auto heights = material.surface.mesh.vertices.col(2).array();
    EXPECT_TRUE((heights == 0 || heights == 0.01).all());
    // STL has no connectivity: copies of a vertex must not have fallen together.
    const TriangleMesh read = read_mesh(folder / (std::string(to_string(material.material)) + ".stl"));
    EXPECT_TRUE(problems(read).empty()) << problems(read).front();
    EXPECT_NEAR(enclosed_volume(read) / (1e9 * material.volume), 1, 1e-5);
    volume += material.volume;
  }
  EXPECT_NEAR(volume / body.volume, 1, 1e-3);
  EXPECT_TRUE(std::filesystem::exists(folder / "print.3mf"));
  test::expect_input_error([&] { printed_body(plate, densities, {}); }, {"thickness"});
}

// Stiff: a square of 2 x 2 cells of 5 mm, and a strip of 1 x 4 cells of which the middle is cut down to a neck.
TEST(Islands, AreFoundWithTheirSizes)
{
  const SimplexMesh<2> plate = grid<2>({0.05, 0.05}, {10, 10});
  Vec densities = Vec::Zero(plate.element_count());
  for (int e = 0; e < densities.size(); ++e) {
    Eigen::Vector2d centre = Eigen::Vector2d::Zero();
    for (const int i : plate.elements.row(e)) centre += plate.positions.segment<2>(2 * i) / 3;
    if ((centre.array() > 0.01).all() && (centre.array() < 0.02).all()) densities[e] = 1;
    if (centre.x() > 0.03 && centre.x() < 0.035 && centre.y() > 0.02 && centre.y() < 0.04) densities[e] = 1;
  }
  const std::vector<Island> islands = find_islands<2>(plate, densities, 1e-3);
  ASSERT_EQ(islands.size(), 3U);
  EXPECT_EQ(islands[0].material, CharacterMaterial::Soft);
  EXPECT_NEAR(islands[0].volume, 23e-4, 1e-12);
  for (int k = 1; k < 3; ++k) {
    const Island& island = islands[std::size_t(k)];
    EXPECT_EQ(island.material, CharacterMaterial::Stiff);
    EXPECT_NEAR(island.volume, 1e-4, 1e-12);
    EXPECT_EQ(island.necks, 0);
  }
  const bool is_square_first = islands[1].centre.x() < 0.02;
  const Island& square = islands[is_square_first ? 1 : 2];
  const Island& strip = islands[is_square_first ? 2 : 1];
  EXPECT_LT((square.centre - Vec3(0.015, 0.015, 0)).norm(), 1e-12);
  EXPECT_LT((square.upper_corner - Vec3(0.02, 0.02, 0)).norm(), 1e-12);
  EXPECT_NEAR(square.inscribed_diameter, 0.01, 1e-12);  // its middle is a vertex
  EXPECT_NEAR(strip.inscribed_diameter, 2 * 0.005 / (2 + std::sqrt(2.0)), 1e-12);
  EXPECT_TRUE(square.is_printable(5e-3));
  EXPECT_FALSE(strip.is_printable(5e-3));
  const std::string table = island_table<2>(islands, 5e-3);
  EXPECT_NE(table.find("stiff,8,100,15.000,15.000,0.000,10.000,10.000,0.000,10.000"), std::string::npos) << table;
  EXPECT_NE(table.find("too small to print"), std::string::npos);
}

// Two cubes of 3 x 3 x 3 cells joined by one cell.
TEST(Islands, NecksAreFound)
{
  const SimplexMesh<3> body = grid<3>({0.07, 0.03, 0.03}, {7, 3, 3});
  const std::vector<bool> inside = chosen(body, [](const Vec3& p) {
    return p.x() < 0.03 || p.x() > 0.04 || (p.y() > 0.01 && p.y() < 0.02 && p.z() > 0.01 && p.z() < 0.02);
  });
  Vec densities(body.element_count());
  for (int e = 0; e < densities.size(); ++e) densities[e] = inside[std::size_t(e)] ? 1 : 0;
  const auto stiff = [&](double size) {
    for (const Island& island : find_islands<3>(body, densities, size))
      if (island.material == CharacterMaterial::Stiff) return island;
    return Island{};
  };
  EXPECT_EQ(stiff(0.004).necks, 0);
  EXPECT_EQ(stiff(0.008).necks, 1);
  EXPECT_NEAR(stiff(0.004).volume, 55e-6, 1e-15);
}

class Drilling : public ::testing::Test {
 protected:
  Drilling()
  {
    Vec moved = mesh.positions;
    for (Eigen::Index i = 0; i < moved.size(); i += 2) moved[i] += 0.3 * moved[i + 1];
    plan = drill_plan({{"rest", {{0, 0}, {0.04, 0}, {0.041, 0.03}}, mesh.positions},
                       {"lean", {{0, 0}, {0.04, 0}, {0.05, 0.03}}, moved}},
                      mesh.elements);
  }

  PlanarMesh mesh = grid<2>({0.04, 0.03}, {4, 3});
  DrillPlan plan;
};

TEST_F(Drilling, PlatesHoldEverythingAndShareTheirDatum)
{
  EXPECT_LT((plan.datum - Eigen::Vector2d(-0.015, -0.015)).norm(), 1e-12);
  EXPECT_LT((plan.size - Eigen::Vector2d(0.08, 0.06)).norm(), 1e-12);
  EXPECT_LT((plan.hole(1, 2) - Eigen::Vector2d(0.065, 0.045)).norm(), 1e-12);
  EXPECT_TRUE(crowded_holes(plan).empty());
  plan.poses[1].holes[1] = {0.0495, 0.031};
  ASSERT_EQ(crowded_holes(plan).size(), 1U);
  EXPECT_EQ(crowded_holes(plan)[0], "lean: 2 and 3");
}

// The file, read back, has the holes where the pins are, at true scale.
TEST_F(Drilling, TheDrawingReadsBack)
{
  const test::TemporaryFolder folder;
  write_drill_svg(folder / "lean.svg", plan, 1);
  const std::string text = read_text(folder / "lean.svg");
  std::smatch found;
  ASSERT_TRUE(std::regex_search(text, found,
                                std::regex("width=\"([0-9.]+)mm\" height=\"([0-9.]+)mm\" viewBox=\"0 0 "
                                           "([0-9.]+) ([0-9.]+)\"")));
  EXPECT_EQ(found[1], found[3]);
  EXPECT_EQ(found[2], found[4]);
  ASSERT_TRUE(std::regex_search(
      text, found, std::regex("<rect x=\"([0-9.]+)\" y=\"([0-9.]+)\" width=\"([0-9.]+)\" height=\"([0-9.]+)\"")));
  const double left = std::stod(found[1]), top = std::stod(found[2]), height = std::stod(found[4]);
  EXPECT_NEAR(std::stod(found[3]), 80, 1e-9);
  EXPECT_NEAR(height, 60, 1e-9);
  const std::string holes = text.substr(text.find("<g id=\"holes\""));
  const std::regex circle("<circle cx=\"([0-9.]+)\" cy=\"([0-9.]+)\" r=\"1.000\"");
  std::size_t pin = 0;
  for (std::sregex_iterator at(holes.begin(), holes.end(), circle), end; at != end; ++at, ++pin) {
    const Eigen::Vector2d read(std::stod((*at)[1]) - left, top + height - std::stod((*at)[2]));
    EXPECT_LT((1e-3 * read + plan.datum - plan.poses[1].holes[pin]).norm(), 1e-6);
    // ... and so say the dimensions and the table.
    for (const double ordinate : {read.x(), read.y()}) {
      std::ostringstream number;
      number.precision(2);
      number << std::fixed << ordinate;
      const std::string label = ">" + number.str() + "<";
      EXPECT_NE(text.find(label), text.rfind(label)) << label;
    }
  }
  EXPECT_EQ(pin, 3U);
  EXPECT_NE(drill_table(plan).find("lean,3,65.000,45.000,2.000"), std::string::npos) << drill_table(plan);
}

}  // namespace
}  // namespace softform::testing
