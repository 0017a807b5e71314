// Purpose: how the sparse regulariser controls the number of actuators (thesis section 5.4.2, figure 5.2): the tower's
// five poses by forces at few of its boundary's vertices, for growing k_sparse in (5.9), and for a requested range.
// Claim: the number of actuators never rises with k_sparse, and a requested range is met.

#include <fmt/format.h>

#include "softform/characters/drawing.hpp"
#include "softform/characters/pose_error.hpp"
#include "softform/characters/sparse_actuation.hpp"
#include "softform/experiment/experiment.hpp"
#include "softform/experiment/run.hpp"
#include "softform/materials/registry.hpp"
#include "softform/mesh/planar_mesh.hpp"

namespace {

using namespace softform;

constexpr double shear_modulus = 1.6163e5;  // [Pa] of RTV 141 silicone, the fit in datasets/materials/silicone.json
constexpr double thickness = 0.01;          // [m]; it scales the forces and nothing else

void write_pose(Run& run, const std::string& name, const PlanarMesh& mesh, const Vec& x)
{
  CsvTable& points = run.series(name + "_points", {{"x", "m"}, {"y", "m"}});
  for (int i = 0; i < mesh.vertex_count(); ++i) points.add_row({x[2 * i], x[2 * i + 1]});
}

void write_actuation(Run& run, const std::string& name, const PlanarMesh& mesh, const PointActuation& actuation)
{
  write_pose(run, name, mesh, actuation.positions.back());
  CsvTable& forces = run.series(name + "_forces", {{"x", "m"}, {"y", "m"}, {"f_x", "N"}, {"f_y", "N"}});
  for (int j = 0; j < actuation.count(); ++j) {
    const Eigen::Vector2d at =
        actuation.positions.back().segment<2>(2 * actuation.vertices[static_cast<std::size_t>(j)]);
    const Eigen::Vector2d force = actuation.forces.back().segment<2>(2 * j);
    forces.add_row({at.x(), at.y(), force.x(), force.y()});
  }
}

void sweep(Run& run)
{
  // 1. The tower with its five poses, of one silicone.
  PosedCharacter tower = make_character(load_drawing("tour_eiffel"), run.by_size(300, 525));
  if (!run.is_paper()) tower.targets.resize(2);
  SolidOptions<2> options;
  options.thickness = thickness;
  const Mixture silicone(plane_stress(make_material("neo_hookean", {{"mu", shear_modulus}})));
  const PlanarSolid body(tower.rest.elements, tower.rest.positions, silicone, options);
  CsvTable& triangles = run.series("triangles", {{"a", "1"}, {"b", "1"}, {"c", "1"}});
  for (const auto& t : tower.rest.elements.rowwise())
    triangles.add_row({static_cast<double>(t[0]), static_cast<double>(t[1]), static_cast<double>(t[2])});
  write_pose(run, "target", tower.rest, tower.targets.back());

  // 2. Fewer actuators as k_sparse grows.
  CsvTable& counts = run.series("counts", {{"k_sparse", "mm^2/N^(1/2)"}, {"actuators", "1"}, {"mean_error", "m"}});
  int previous = tower.rest.vertex_count(), rises = 0;
  double infeasibility = 0;
  const std::vector<double> weights =
      run.by_size<std::vector<double>>({1, 10, 100}, {0.1, 0.3, 1, 3, 10, 30, 100, 300});
  for (const double weight : weights) {
    run.step(fmt::format("k_sparse {:g}", weight));
    const PointActuation actuation = sparse_actuation(body, tower.targets, weight);
    double mean = 0;
    for (std::size_t i = 0; i < tower.targets.size(); ++i)
      mean += pose_error<2>(actuation.positions[i], tower.targets[i]).mean / static_cast<double>(tower.targets.size());
    counts.add_row({weight, static_cast<double>(actuation.count()), mean});
    run.metric(fmt::format("actuators_{:g}", weight), actuation.count(), "1");
    rises += actuation.count() > previous ? 1 : 0;
    previous = actuation.count();
    infeasibility = std::max(infeasibility, actuation.infeasibility);
    write_actuation(run, fmt::format("k_{:g}", weight), tower.rest, actuation);
  }
  run.metric("rises", rises, "1");
  run.metric("max_infeasibility", infeasibility, "N");

  // 3. A requested range.
  const PointActuation chosen = actuation_in_range(body, tower.targets, {4, 6}, {}, [&](const std::string& text) {
    run.step(text);
    return true;
  });
  run.metric("actuators_requested_4_to_6", chosen.count(), "1");
  write_actuation(run, "requested", tower.rest, chosen);
}

}  // namespace

int main(int argc, char** argv)
{
  return softform::run_experiment(
      argc, argv,
      {"fig_5_2", "5.4.2", "The number of actuators falls as k_sparse grows, and a requested range is met.", {1, 3}},
      sweep);
}
