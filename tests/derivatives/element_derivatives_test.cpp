#include <gtest/gtest.h>

#include "softform/fem/enclosed_volume.hpp"
#include "softform/fem/membrane.hpp"
#include "softform/mesh/shapes.hpp"
#include "support/deformations.hpp"
#include "support/finite_differences.hpp"
#include "support/materials.hpp"

namespace softform::testing {
namespace {

// Every material on a small closed mesh: stretched unequally, and by the same stretch in every direction, where
// Ogden's series branch is taken.
class MembraneDerivatives : public ::testing::TestWithParam<std::string> {
 protected:
  MembraneDerivatives()
      : mesh(sphere(0.05, 60)),
        membrane(mesh.triangles, mesh.vertex_count(), example_of(GetParam()),
                 Vec::LinSpaced(mesh.triangle_count(), 2e-4, 4e-4)),
        rest(flatten(mesh.vertices))
  {}

  void check(const Vec& x)
  {
    const double step = 1e-3 * 0.05;
    const Vec direction = wiggle(static_cast<int>(x.size()), 3), rest_direction = wiggle(static_cast<int>(x.size()), 4);
    Vec g;
    membrane.gradient(x, rest, g);
    EXPECT_SLOPE(check_slope([&](const Vec& y) { return Vec::Constant(1, membrane.value(y, rest)); }, x, direction,
                             Vec::Constant(1, g.dot(direction)), step));
    const auto forces = [&](const Vec& y, const Vec& Y) {
      Vec f;
      membrane.gradient(y, Y, f);
      return f;
    };
    SparseMatrix K, B;
    membrane.hessian(x, rest, K);
    membrane.mixed_hessian(x, rest, B);
    EXPECT_SLOPE(check_slope([&](const Vec& y) { return forces(y, rest); }, x, direction, K * direction, step));
    EXPECT_SLOPE(
        check_slope([&](const Vec& Y) { return forces(x, Y); }, rest, rest_direction, B * rest_direction, step));
  }

  TriangleMesh mesh;
  Membrane membrane;
  Vec rest;
};

TEST_P(MembraneDerivatives, AtUnequalStretches) { check(deformed(mesh)); }

TEST_P(MembraneDerivatives, AtEqualStretches) { check(1.7 * rest); }

INSTANTIATE_TEST_SUITE_P(Materials, MembraneDerivatives, ::testing::ValuesIn(model_names()),
                         [](const auto& model) { return model.param; });

TEST(EnclosedVolumeDerivatives, GradientAndHessian)
{
  const TriangleMesh mesh = sphere(0.05, 60);
  const EnclosedVolume volume(mesh.triangles, mesh.vertex_count());
  const Vec x = deformed(mesh), direction = wiggle(static_cast<int>(x.size()), 5);
  const auto gradient = [&](const Vec& y) {
    Vec g;
    volume.gradient(y, g);
    return g;
  };
  SparseMatrix H = volume.pattern();
  volume.add_hessian(x, 1, H);
  EXPECT_SLOPE(check_slope([&](const Vec& y) { return Vec::Constant(1, volume.value(y)); }, x, direction,
                           Vec::Constant(1, gradient(x).dot(direction)), 1e-3));
  EXPECT_SLOPE(check_slope(gradient, x, direction, H * direction, 1e-3));
}

}  // namespace
}  // namespace softform::testing
