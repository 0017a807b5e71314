// Purpose: the optimisers of thesis section 3.2 on a problem with bounds: the layout of two materials (5.16 to 5.19) in
// a bar of the plane that is held at both ends and should bend in its middle third alone. The state is eliminated, so
// that all that is left is min f(rho), 0 <= rho <= 1; every method of the registry that takes bounds runs on it.
// Claim: methods that share nothing but the programme find the same minimum.

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "comparison.hpp"
#include "softform/experiment/experiment.hpp"
#include "softform/inverse/material_program.hpp"
#include "softform/materials/registry.hpp"

namespace {

using namespace softform;

constexpr double length = 0.08, height = 0.008, thickness = 0.006;  // [m]
constexpr double soft_shear_modulus = 2e5, contrast = 1000;         // [Pa], ratio of the moduli
constexpr double bend = std::numbers::pi / 3;                       // of the middle third

std::shared_ptr<const SolidMaterial> rubber(double shear_modulus)
{
  return plane_stress(make_material("neo_hookean", {{"mu", shear_modulus}}));
}

PlanarSolid bar(const SimplexMesh<2>& mesh)
{
  SolidOptions<2> options;
  options.thickness = thickness;
  const Mixture mixture(rubber(soft_shear_modulus), rubber(contrast * soft_shear_modulus), MixturePath::Geometric);
  return PlanarSolid(mesh.elements, mesh.positions, mixture, options);
}

// The bar with its middle third bent into an arc, its axis neither stretched nor its sections warped.
Vec bent(const SimplexMesh<2>& mesh)
{
  const double begin = length / 3, arc = length / 3, radius = arc / bend;
  Vec x = mesh.positions;
  for (int i = 0; i < mesh.vertex_count(); ++i) {
    const double s = mesh.positions[2 * i], angle = bend * std::clamp((s - begin) / arc, 0.0, 1.0);
    const double straight = std::min(s, begin), after = std::max(0.0, s - begin - arc);
    const Eigen::Vector2d axis(straight + radius * std::sin(angle) + after * std::cos(angle),
                               radius * (1 - std::cos(angle)) + after * std::sin(angle));
    x.segment<2>(2 * i) =
        axis + (mesh.positions[2 * i + 1] - height / 2) * Eigen::Vector2d(-std::sin(angle), std::cos(angle));
  }
  return x;
}

FixedDofs held_ends(const SimplexMesh<2>& mesh)
{
  FixedDofs fixed{Vec::Ones(mesh.positions.size())};
  for (int i = 0; i < mesh.vertex_count(); ++i)
    if (mesh.positions[2 * i] < 1e-9 || mesh.positions[2 * i] > length - 1e-9) fixed.free.segment<2>(2 * i).setZero();
  return fixed;
}

// The problem and the state of the uniform bar that all methods start from. Its parts refer to each other: it stays
// where it is, alive with the instance.
struct BarLayout {
  explicit BarLayout(int cells_along) : mesh(grid<2>({length, height}, {cells_along, 4})) {}
  BarLayout(const BarLayout&) = delete;
  BarLayout& operator=(const BarLayout&) = delete;

  SimplexMesh<2> mesh;
  PlanarSolid body = bar(mesh);
  MaterialDesign<2> design{body, {{bent(mesh), bent(mesh), held_ends(mesh), {}, {}, {}}}};
  MaterialDesign<2>::State first = design.start(Vec::Constant(body.element_count(), 0.5)).value();
};

void compare_all(Run& run)
{
  const auto layout = std::make_shared<BarLayout>(run.by_size(20, 40));
  const MaterialWeights weights;  // without k_mat: one problem, not a continuation of them
  Instance instance;
  instance.name = "bar";
  instance.largest_cpu_s = run.by_size(3, 60);
  instance.reduced = [layout, weights] { return material_program<2>(layout->design, layout->first, weights); };
  run.metric("uniform_objective", layout->design.objective(layout->first, weights), "1");
  Comparison(run).layout(instance);
}

}  // namespace

int main(int argc, char** argv)
{
  return softform::run_experiment(
      argc, argv,
      {"sec_3_2_layout",
       "3.2",
       "On a layout of two materials, methods with nothing in common find the same minimum.",
       {1, 3}},
      compare_all);
}
