// Purpose: a tower danced by five strings (thesis sections 5.4.2, 5.4.3, figure 5.4, and the rows of tables 5.1 and
// 5.2): strings that only pull, from places on the boundary to a ring around the body, the same in five poses.
// Claim: five strings bring the tower within the errors of table 5.1, every pose a stable equilibrium that is reached
// from rest by drawing the strings.

#include <algorithm>

#include <fmt/format.h>

#include "softform/characters/drawing.hpp"
#include "softform/characters/pose_error.hpp"
#include "softform/characters/reachability.hpp"
#include "softform/characters/string_selection.hpp"
#include "softform/experiment/experiment.hpp"
#include "softform/experiment/run.hpp"
#include "softform/materials/registry.hpp"
#include "softform/mesh/planar_mesh.hpp"

namespace {

using namespace softform;

constexpr double shear_modulus = 1.6163e5;  // [Pa] of RTV 141 silicone, the fit in datasets/materials/silicone.json
constexpr double thickness = 0.01;          // [m]; it scales the tensions and nothing else
constexpr int string_count = 5;

// The soles of the feet, which are clamped.
FixedDofs soles(const PlanarMesh& mesh)
{
  FixedDofs held{Vec::Ones(mesh.positions.size())};
  for (int i = 0; i < mesh.vertex_count(); ++i)
    if (mesh.positions[2 * i + 1] < 1e-9) held.free.segment<2>(2 * i).setZero();
  return held;
}

void dance(Run& run)
{
  PosedCharacter tower = make_character(load_drawing("tour_eiffel"), run.by_size(300, 525));
  SolidOptions<2> options;
  options.thickness = thickness;
  const Mixture silicone(plane_stress(make_material("neo_hookean", {{"mu", shear_modulus}})));
  const PlanarSolid body(tower.rest.elements, tower.rest.positions, silicone, options);
  const Vec densities = Vec::Zero(body.element_count());
  const FixedDofs held = soles(tower.rest);
  std::vector<Vec> all = tower.targets;
  all.push_back(tower.rest.positions);
  const Ring ring = ring_around(all);
  for (std::size_t i = 0; i < tower.targets.size(); ++i) {
    const Vec moved = (tower.targets[i] - tower.rest.positions).cwiseProduct((1 - held.free.array()).matrix());
    run.progress(fmt::format("{}: feet move {:.3g} mm", tower.names[i], 1e3 * largest_nodal_norm(moved, 2)));
  }
  run.progress(fmt::format("ring {} {} {}", ring.centre.x(), ring.centre.y(), ring.radius));

  StringSelection selection;
  run.time("stage_1", [&] {
    selection = select_strings(body, densities, held, tower.targets, ring, getenv("N0") ? atoi(getenv("N0")) : 8, {},
                               [&](const std::string& text) { run.progress(text); });
  });
  const auto show = [&](const StringLayout& strings, const StringPoses& poses) {
    for (std::size_t i = 0; i < tower.targets.size(); ++i) {
      const PoseError error = pose_error<2>(poses.positions[i], tower.targets[i]);
      run.progress(fmt::format("{:12s} {:.2f} / {:.2f} mm   tau", tower.names[i],
                               1e3 * error.max, 1e3 * error.mean));
    }
    for (int j = 0; j < strings.count(); ++j)
      {std::string t; for (const Vec& v : strings.tensions) t += fmt::format(" {:.2f}", v[j]); 
      run.progress(fmt::format("place {:.1f} {:.1f} angle {:.1f} tau {}", 1e3 * strings.places[j].x(),
                               1e3 * strings.places[j].y(), strings.angles[j] * 57.29578, t));}
    run.progress(fmt::format("negative {} residual {:.1e} failed {}", poses.negative_eigenvalues, poses.residual,
                             poses.failed_equilibria));
  };
  show(selection.strings, selection.poses);
  StringPlacement placement;
  run.time("stage_2", [&] {
    placement = place_strings(body, densities, held, tower.targets, selection.strings, selection.poses.positions);
  });
  run.progress(fmt::format("{} iterations, {} failed inside", placement.iterations, placement.failed_equilibria));
  show(placement.strings, placement.poses);
  run.time("thin", [&] {
    placement = thinned_strings(body, densities, held, tower.targets, placement, string_count, {},
                               [&](const std::string& text) { run.progress(text); });
  });
  show(placement.strings, placement.poses);
  run.time("exchange", [&] {
    placement = exchange_strings(body, densities, held, tower.targets, placement, {},
                                 [&](const std::string& text) { run.progress(text); });
  });
  run.progress(fmt::format("{} iterations, {} failed inside", placement.iterations, placement.failed_equilibria));
  show(placement.strings, placement.poses);
}

}  // namespace

int main(int argc, char** argv)
{
  return softform::run_experiment(argc, argv, {"fig_5_4", "5.4.3", "Five strings bring a tower to five poses.", {1, 2}},
                                  dance);
}
