// Bodies with poses that come as meshes: ways from rest, targets inside of a surface, clamps.

#include <cmath>

#include <gtest/gtest.h>

#include "softform/characters/bent_bar.hpp"
#include "softform/characters/clamp_pipeline.hpp"
#include "softform/characters/posed_mesh_file.hpp"
#include "softform/io/vtk_io.hpp"
#include "softform/mesh/planar_mesh.hpp"
#include "support/expect_input_error.hpp"
#include "support/solids.hpp"
#include "support/temporary_folder.hpp"

namespace softform::testing {
namespace {

// A straight bar that curls by more than half a circle.
struct Curl : ::testing::Test {
  SimplexMesh<3> bar = grid<3>({0.08, 0.004, 0.006}, {40, 2, 2});
  std::vector<Bend> bends{{0.005, 0.075, -250 * M_PI / 180}};
  Vec target = bent_bar(bar, bends);
};

TEST_F(Curl, TheWayBeginsAtRestAndEndsAtTheTarget)
{
  const PoseWay way = rigid_way<3>(bar, {target});
  EXPECT_LT((way(0, 0) - bar.positions).lpNorm<Eigen::Infinity>(), 1e-12);
  EXPECT_LT((way(0, 1) - target).lpNorm<Eigen::Infinity>(), 1e-12);
}

TEST_F(Curl, TheWayTurnsEvenlyWithoutStretching)
{
  const PoseWay way = rigid_way<3>(bar, {target});
  const Vec half = way(0, 0.5);
  require_upright<3>({bar, {}, {"half"}, {half}, {}}, "the way");
  // Up to a rigid motion it is the bar bent by half of the angle.
  const Positions bent = unflatten(bent_bar(bar, bends, 0.5)), x = unflatten(half);
  for (int i = 0; i < bar.vertex_count(); i += 7)
    for (int j = 0; j < i; j += 11) EXPECT_NEAR((x.row(i) - x.row(j)).norm(), (bent.row(i) - bent.row(j)).norm(), 2e-4);
}

TEST(RigidWay, OfAPlanarBodyTurnsBeyondHalfACircle)
{
  const PlanarMesh mesh = grid<2>({0.1, 0.01}, {40, 4});
  const double angle = 1.5 * M_PI;
  Vec target(mesh.positions.size());
  for (int i = 0; i < mesh.vertex_count(); ++i) {
    const double a = angle * mesh.positions[2 * i] / 0.1, r = 0.1 / angle + 0.005 - mesh.positions[2 * i + 1];
    target.segment<2>(2 * i) << r * std::sin(a), -r * std::cos(a);
  }
  const PoseWay way = rigid_way<2>(mesh, {target});
  EXPECT_LT((way(0, 1) - target).lpNorm<Eigen::Infinity>(), 1e-12);
  const Vec half = way(0, 0.5);
  // The directions of both ends, a quarter of the way round each.
  const auto direction = [&](int bottom, int top) {
    const Eigen::Vector2d d = half.segment<2>(2 * top) - half.segment<2>(2 * bottom);
    return std::atan2(d.y(), d.x());
  };
  const double turned = direction(40, 4 * 41 + 40) - direction(0, 4 * 41);
  EXPECT_NEAR(std::remainder(turned - 0.5 * angle, 2 * M_PI), 0, 0.05);
}

TEST(FilledTarget, IsAffineInsideAnAffineSurface)
{
  const SimplexMesh<3> block = uneven_block<3>(0.02, 4);
  Eigen::Matrix3d F;
  F << 1.2, 0.3, 0, -0.2, 0.9, 0.1, 0, 0.2, 1.1;
  Vec expected(block.positions.size()), surface = Vec::Zero(block.positions.size());
  for (int i = 0; i < block.vertex_count(); ++i)
    expected.segment<3>(3 * i) = F * block.positions.segment<3>(3 * i) + Vec3(0.1, 0, 0);
  for (const int i : boundary_vertices<3>(block.elements)) surface.segment<3>(3 * i) = expected.segment<3>(3 * i);
  EXPECT_LT((filled_target(block, surface) - expected).lpNorm<Eigen::Infinity>(), 1e-9);
}

TEST_F(Curl, ClampsMoveRigidlyAndMustNotOverlap)
{
  PosedMesh<3> body{bar, {}, {"curl"}, {target}, rigid_way<3>(bar, {target})};
  const auto within = [&](double from, double to) {
    std::vector<int> vertices;
    for (int i = 0; i < bar.vertex_count(); ++i)
      if (bar.positions[3 * i] >= from - 1e-9 && bar.positions[3 * i] <= to + 1e-9) vertices.push_back(i);
    return vertices;
  };
  const std::vector<Clamp> clamps{{"near", within(0, 0.02)}, {"far", within(0.07, 0.08)}};
  // The near clamp reaches into the bend: it is moved as a whole.
  for (const double t : {0.3, 1.0}) {
    const Vec x = clamped_positions<3>(body, clamps, 0, t);
    for (const Clamp& clamp : clamps)
      for (const int i : clamp.vertices)
        EXPECT_NEAR((x.segment<3>(3 * i) - x.segment<3>(3 * clamp.vertices[0])).norm(),
                    (bar.positions.segment<3>(3 * i) - bar.positions.segment<3>(3 * clamp.vertices[0])).norm(), 1e-12);
  }
  const Solid<3> solid(bar.elements, bar.positions, Mixture(neo_hookean_solid(1e5, 3e5)));
  ClampPipelineOptions options;
  options.last_stage = 2;
  const auto run = [&](const std::vector<Clamp>& bad) { run_clamp_pipeline<3>(solid, body, bad, options); };
  test::expect_input_error(
      [&] {
        run({{"near", within(0, 0.02)}, {"far", within(0.02, 0.08)}});
      },
      {"'near' and 'far'", "move them apart"});
  test::expect_input_error([&] { run({{"near", {0, 1}}}); }, {"'near'", "2 vertices"});
  test::expect_input_error([&] { run({{"near", {0, 1, 2}}}); }, {"'near'", "not on a line"});
  test::expect_input_error([&] { run({}); }, {"nothing is clamped"});
  body.targets[0].setZero();
  test::expect_input_error([&] { run(clamps); }, {"pose 'curl'", "tetrahedron 0"});
}

TEST(PosedMeshFile, TetrahedraComeBackAndOthersAreRefused)
{
  const test::TemporaryFolder folder;
  SimplexMesh<3> block = uneven_block<3>(20, 2);
  write_vtu<3>(folder / "rest.vtu", block);
  block.positions *= 1.5;
  write_vtu<3>(folder / "grown.vtu", block);
  const PosedMesh<3> body = read_posed_mesh<3>(folder / "rest.vtu", {{"grown", folder / "grown.vtu"}}, 1e-3);
  EXPECT_EQ(body.rest.elements, block.elements);
  EXPECT_LT((body.targets[0] - 1.5 * body.rest.positions).lpNorm<Eigen::Infinity>(), 1e-15);
  block.elements.row(3).swap(block.elements.row(4));
  write_vtu<3>(folder / "other.vtu", block);
  test::expect_input_error(
      [&] {
        read_posed_mesh<3>(folder / "rest.vtu", {{"other", folder / "other.vtu"}}, 1e-3);
      },
      {"other.vtu", "element 3", "rest.vtu"});
  write_vtu<2>(folder / "flat.vtu", grid<2>({1, 1}, {2, 2}));
  test::expect_input_error([&] { read_posed_mesh<3>(folder / "flat.vtu", {}, 1e-3); }, {"cell 0", "tetrahedron"});
  test::expect_input_error([&] { read_posed_mesh<2>(folder / "rest.vtu", {}, 1e-3); }, {"z = "});
  test::expect_input_error([&] { read_posed_mesh<3>(folder / "none.vtu", {}, 1e-3); }, {"none.vtu", "no such file"});
  folder.write("empty.vtu", "nothing");
  test::expect_input_error([&] { read_posed_mesh<3>(folder / "empty.vtu", {}, 1e-3); }, {"empty.vtu"});
}

}  // namespace
}  // namespace softform::testing
