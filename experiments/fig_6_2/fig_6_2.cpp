// Purpose: what internal connections do (thesis 6.3, figure 6.2): a pillow of 2 m x 1 m with and without a wall of
// 0.15 m between front and back across its middle. Claim: the wall makes a sharp crease, which a single closed skin
// cannot have.

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include "softform/experiment/experiment.hpp"
#include "softform/experiment/run.hpp"
#include "softform/inflatables/inflatable.hpp"
#include "softform/inflatables/pillow.hpp"
#include "softform/io/vtk_io.hpp"
#include "softform/materials/tension_field.hpp"

namespace {

using namespace softform;

// The front sheet's vertices across its middle.
std::vector<int> middle_line(int columns, int rows)
{
  std::vector<int> line;
  for (int j = 0; j <= rows; ++j) line.push_back(columns / 2 + (columns + 1) * j);
  return line;
}

// The turn of the skin along x at the middle of the front [degrees]: between the chords to the vertices left and right.
double crease_angle(const Positions& nodes, int vertex)
{
  const Vec3 left = nodes.row(vertex) - nodes.row(vertex - 1), right = nodes.row(vertex + 1) - nodes.row(vertex);
  return std::atan2(left.cross(right).norm(), left.dot(right)) * 180 / std::numbers::pi;
}

TriangleMesh part(const PanelLayout& layout, const Positions& nodes, bool walls)
{
  const std::vector<int> panels = panel_of_triangles(layout);
  const Triangles all = node_triangles(layout);
  std::vector<int> chosen;
  for (int t = 0; t < all.rows(); ++t)
    if (layout.panels[std::size_t(panels[std::size_t(t)])].is_wall == walls) chosen.push_back(t);
  return {nodes, all(chosen, Eigen::all)};
}

void inflate_pillows(Run& run)
{
  constexpr double kappa = 1e8, thickness = 1e-4, pressure = 20;  // kappa h / (p x 1 m) = 500
  const int rows = run.by_size(20, 40), columns = 2 * rows;
  const TriangleMesh sheet = rectangle(2, 1, columns, rows);
  const std::vector<int> line = middle_line(columns, rows);
  const auto material = std::make_shared<TensionField>(kappa, 0, 1e-6);

  for (const bool has_wall : {true, false}) {
    const std::string name = has_wall ? "with_wall" : "without_wall";
    run.step(name);
    // 1. The panels, and their equilibrium under pressure.
    const PanelLayout layout = has_wall ? pillow_with_wall(sheet, line, 0.15, 0.15) : pillow(sheet);
    const Inflatable inflatable(layout, material, thickness, pressure);
    const Vec flat = flat_vector(layout);
    SparseFactorization factorization;
    Equilibrium equilibrium;
    run.time(name, [&] { equilibrium = inflate(inflatable, flat, flatten(layout.nodes), factorization); });

    // 2. The crease, in the middle of the front.
    const Positions nodes = unflatten(equilibrium.x);
    const int middle = line[line.size() / 2];
    run.metric("crease_angle_" + name, crease_angle(nodes, middle), "deg");
    run.metric("height_at_crease_" + name, 2 * nodes(middle, 2), "m");
    run.metric("largest_height_" + name, 2 * nodes.col(2).maxCoeff(), "m");
    run.metric("volume_" + name, inflatable.volume().value(equilibrium.x), "m^3");
    run.metric("iterations_" + name, equilibrium.iterations, "1");
    run.metric("max_residual_" + name, equilibrium.residual, "1");

    // 3. Skins and walls apart, for the picture, and the profile along the middle.
    write_vtp(run.path(name + ".vtp"), part(layout, nodes, false));
    if (has_wall) write_vtp(run.path("wall.vtp"), part(layout, nodes, true));
    auto& profile = run.series("profile_" + name, {{"x", "m"}, {"z", "m"}});
    const int first = middle - columns / 2;
    for (int i = first; i <= first + columns; ++i) profile.add_row({nodes(i, 0), nodes(i, 2)});
  }
}

}  // namespace

int main(int argc, char** argv)
{
  return softform::run_experiment(
      argc, argv,
      {"fig_6_2", "6.3", "Internal connections make sharp creases that a closed skin cannot have.", {0.05, 0.2}},
      inflate_pillows);
}
