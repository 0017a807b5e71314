// The membrane element against the three-dimensional theory that it comes from (thesis 3.1.4).

#include <cmath>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "softform/fem/membrane.hpp"
#include "softform/mesh/triangle_mesh.hpp"
#include "support/materials.hpp"

namespace softform::testing {
namespace {

constexpr double thickness = 3e-4;  // [m]

// A flat unit square of 6 x 6 cells whose inner vertices are displaced irregularly.
TriangleMesh flat_sheet()
{
  constexpr int cells = 6, side = cells + 1;
  TriangleMesh sheet;
  sheet.vertices.resize(side * side, 3);
  sheet.triangles.resize(2 * cells * cells, 3);
  for (int j = 0; j < side; ++j) {
    for (int i = 0; i < side; ++i) {
      const bool is_inside = i > 0 && i < cells && j > 0 && j < cells;
      const double offset = is_inside ? 0.3 / cells : 0;
      sheet.vertices.row(j * side + i) << double(i) / cells + offset * std::sin(5 * i + 3 * j),
          double(j) / cells + offset * std::cos(2 * i + 7 * j), 0;
    }
  }
  for (int j = 0, t = 0; j < cells; ++j) {
    for (int i = 0; i < cells; ++i, t += 2) {
      const int a = j * side + i, b = a + 1, c = a + side + 1, d = a + side;
      sheet.triangles.row(t) << a, b, c;
      sheet.triangles.row(t + 1) << a, c, d;
    }
  }
  return sheet;
}

bool is_on_boundary(const TriangleMesh& sheet, int i)
{
  const auto on_side = [](double s) { return s < 1e-9 || s > 1 - 1e-9; };
  return on_side(sheet.vertices(i, 0)) || on_side(sheet.vertices(i, 1));
}

// A homogeneous deformation into space: the images of the sheet's two directions.
Eigen::Matrix<double, 3, 2> in_plane_deformation()
{
  Eigen::Matrix<double, 3, 2> F;
  F << 1.4, 0.5, -0.3, 1.8, 0.6, 0.2;
  return F;
}

Vec deformed_homogeneously(const TriangleMesh& sheet, const Eigen::Matrix<double, 3, 2>& F)
{
  const Positions x = sheet.vertices.leftCols<2>() * F.transpose();
  return flatten(x);
}

class PatchTest : public ::testing::TestWithParam<std::string> {
 protected:
  PatchTest()
      : sheet(flat_sheet()),
        material(example_of(GetParam())),
        membrane(sheet.triangles, sheet.vertex_count(), material, Vec::Constant(sheet.triangle_count(), thickness))
  {}

  TriangleMesh sheet;
  std::shared_ptr<const Material> material;
  Membrane membrane;
};

// The energy is the density times the rest volume.
TEST_P(PatchTest, EnergyIsDensityTimesRestVolume)
{
  Eigen::Matrix<double, 3, 2> F = Eigen::Matrix<double, 3, 2>::Zero();
  F(1, 0) = 1.3;
  F(2, 1) = 1.9;
  const double found = membrane.value(deformed_homogeneously(sheet, F), flatten(sheet.vertices));
  EXPECT_NEAR(found / (energy(*material, 1.3, 1.9) * thickness), 1, 1e-12);
}

// A homogeneous state is in equilibrium inside, whatever the mesh.
TEST_P(PatchTest, InnerVerticesAreBalanced)
{
  Vec g;
  membrane.gradient(deformed_homogeneously(sheet, in_plane_deformation()), flatten(sheet.vertices), g);
  const Positions forces = unflatten(g);
  const double largest = forces.cwiseAbs().maxCoeff();
  ASSERT_GT(largest, 0);
  int inner = 0;
  for (int i = 0; i < sheet.vertex_count(); ++i) {
    if (is_on_boundary(sheet, i)) continue;
    ++inner;
    EXPECT_LT(forces.row(i).norm(), 1e-12 * largest) << "vertex " << i;
  }
  EXPECT_EQ(inner, 25);
}

INSTANTIATE_TEST_SUITE_P(Materials, PatchTest, ::testing::ValuesIn(model_names()),
                         [](const auto& model) { return model.param; });

// The two kinematic assumptions in three dimensions: the normal stays normal (no transverse shear) and the thickness
// changes so that det F = 1. The element's energy is then that of the full C = F^t F (A.5).
TEST(MembraneKinematics, EnergyIsThatOfAnIncompressibleSolidWithoutTransverseShear)
{
  const Eigen::Matrix<double, 3, 2> in_plane = in_plane_deformation();
  const Vec3 area = in_plane.col(0).cross(in_plane.col(1));
  Eigen::Matrix3d F;
  F << in_plane, area / area.squaredNorm();
  ASSERT_NEAR(F.determinant(), 1, 1e-14);
  const Eigen::Matrix3d C = F.transpose() * F;
  ASSERT_NEAR(C.topRightCorner(2, 1).norm(), 0, 1e-14);
  const double I1 = C.trace(), I2 = 0.5 * (I1 * I1 - (C * C).trace());
  const double mu_1 = 0.3e6, mu_2 = 0.05e6;

  const TriangleMesh sheet = flat_sheet();
  const Membrane membrane(sheet.triangles, sheet.vertex_count(),
                          make_material("mooney_rivlin", {{"mu_1", mu_1}, {"mu_2", mu_2}}),
                          Vec::Constant(sheet.triangle_count(), thickness));
  const double found = membrane.value(deformed_homogeneously(sheet, in_plane), flatten(sheet.vertices));
  EXPECT_NEAR(found / (thickness * (0.5 * mu_1 * (I1 - 3) + 0.5 * mu_2 * (I2 - 3))), 1, 1e-12);
}

}  // namespace
}  // namespace softform::testing
