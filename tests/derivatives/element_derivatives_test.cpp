#include <cmath>
#include <map>
#include <string>
#include <vector>

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
    check_parameters(x);
  }

  void check_parameters(const Vec& x)
  {
    const std::vector<MaterialParameter> parameters = membrane.material().parameters();
    for (std::size_t k = 0; k < parameters.size(); ++k) {
      const auto forces_at = [&](const Vec& value) {
        std::map<std::string, double> changed;
        for (const MaterialParameter& parameter : parameters) changed[parameter.name] = parameter.value;
        changed[parameters[k].name] = value[0];
        Vec f;
        Membrane(mesh.triangles, mesh.vertex_count(), make_material(GetParam(), changed), membrane.thickness())
            .gradient(x, rest, f);
        return f;
      };
      Vec exact;
      membrane.parameter_gradient(x, rest, static_cast<int>(k), exact);
      const double size = parameters[k].value != 0 ? std::abs(parameters[k].value) : 1;
      EXPECT_SLOPE(check_slope(forces_at, Vec::Constant(1, parameters[k].value), Vec::Constant(1, size), size * exact,
                               1e-2, 1e-9));
    }
  }

  // lambda . dW/dx has the gradient (K lambda, B^t lambda) in (x, X).
  void check_force_hessian(const Vec& x)
  {
    const double step = 1e-3 * 0.05;
    const int size = static_cast<int>(x.size());
    const Vec lambda = wiggle(size, 6), direction = wiggle(size, 3), rest_direction = wiggle(size, 4);
    SparseMatrix xx, mixed, XX, K, B;
    membrane.force_hessian(x, rest, lambda, xx, mixed, XX);
    const auto by_x = [&](const Vec& y, const Vec& Y) -> Vec {
      membrane.hessian(y, Y, K);
      return K * lambda;
    };
    const auto by_rest = [&](const Vec& y, const Vec& Y) -> Vec {
      membrane.mixed_hessian(y, Y, B);
      return B.transpose() * lambda;
    };
    const Vec& d = direction;
    const Vec& D = rest_direction;
    EXPECT_SLOPE(check_slope([&](const Vec& y) { return by_x(y, rest); }, x, d, xx * d, step));
    EXPECT_SLOPE(check_slope([&](const Vec& Y) { return by_x(x, Y); }, rest, D, mixed * D, step));
    EXPECT_SLOPE(check_slope([&](const Vec& y) { return by_rest(y, rest); }, x, d, mixed.transpose() * d, step));
    EXPECT_SLOPE(check_slope([&](const Vec& Y) { return by_rest(x, Y); }, rest, D, XX * D, step));
  }

  TriangleMesh mesh;
  Membrane membrane;
  Vec rest;
};

TEST_P(MembraneDerivatives, ForceHessianAtUnequalStretches) { check_force_hessian(deformed(mesh)); }

TEST_P(MembraneDerivatives, ForceHessianAtEqualStretches) { check_force_hessian(1.7 * rest); }

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
