// Tetrahedra from surfaces by TetGen. Skipped where the program is not installed.

#include <cstdlib>

#include <gtest/gtest.h>

#include "softform/fem/solid.hpp"
#include "softform/io/tetgen.hpp"
#include "softform/mesh/shapes.hpp"
#include "support/expect_input_error.hpp"

namespace softform::test {
namespace {

class TetGen : public ::testing::Test {
 protected:
  void SetUp() override
  {
    ASSERT_EQ(std::system("command -v tetgen > /dev/null 2>&1"), 0) << "install tetgen: scripts/packages.txt lists it";
  }
  TriangleMesh surface = sphere(0.05, 200);
};

TEST_F(TetGen, FillsTheSurfaceExactly)
{
  const SimplexMesh<3> mesh = tetrahedralize(surface, "sphere");
  const Solid<3> body(mesh.elements, mesh.positions, Mixture(neo_hookean_solid(1e5, 1e5)));
  EXPECT_NEAR(body.volumes().sum() / enclosed_volume(surface), 1, 1e-9);
  EXPECT_EQ(boundary_faces<3>(mesh.elements).faces.rows(), surface.triangle_count());
  EXPECT_LT((unflatten(mesh.positions).topRows(surface.vertex_count()) - surface.vertices).norm(), 1e-12);
}

TEST_F(TetGen, MeetsACount) { EXPECT_NEAR(tetrahedralize_to_count(surface, "sphere", 4000).element_count(), 4000, 80); }

TEST_F(TetGen, BadInputIsNamed)
{
  TriangleMesh open = surface;
  open.triangles.conservativeResize(open.triangles.rows() - 1, 3);
  expect_input_error([&] { tetrahedralize(open, "open.off"); }, {"open.off"});
  TetrahedralizeOptions missing;
  missing.program = "no-such-tetgen";
  expect_input_error([&] { tetrahedralize(surface, "sphere", missing); }, {"no-such-tetgen", "install"});
}

}  // namespace
}  // namespace softform::test
