#include "softform/inflatables/cut_panels.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <queue>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "softform/core/error.hpp"
#include "softform/inflatables/seam_snapping.hpp"
#include "softform/inflatables/wall_panels.hpp"

namespace softform {
namespace {

Vec3 node_position(const PanelLayout& layout, int vertex)
{
  return layout.nodes.row(layout.node_of[static_cast<std::size_t>(vertex)]);
}

/// A panel's name where it was given one, else its number and where it is.
std::string describe(const PanelLayout& layout, std::size_t panel)
{
  const Panel& p = layout.panels[panel];
  const int middle = layout.triangles(p.first_triangle + p.triangle_count / 2, 0);
  return fmt::format("panel '{}' around {}", p.name, place(node_position(layout, middle)));
}

/// The seams that a loop of panel vertices belongs to.
std::string seams_along(const PanelLayout& layout, const std::vector<int>& loop)
{
  const std::set<int> on_loop(loop.begin(), loop.end());
  std::vector<std::string> names;
  for (const Seam& seam : layout.seams)
    for (const SeamSide& side : seam.sides)
      if (on_loop.count(side.vertices[1]) > 0 && on_loop.count(side.vertices[0]) > 0 &&
          (names.empty() || names.back() != "'" + seam.name + "'"))
        names.push_back("'" + seam.name + "'");
  return fmt::format("{}", fmt::join(names, ", "));
}

/// The ends of the shortest path through the panel from one loop to another.
std::pair<Vec3, Vec3> shortest_link(const PanelLayout& layout, int panel, const std::vector<int>& from,
                                    const std::vector<int>& to)
{
  const Panel& p = layout.panels[static_cast<std::size_t>(panel)];
  const auto neighbours =
      vertex_neighbours(layout.triangles.middleRows(p.first_triangle, p.triangle_count), layout.vertex_count());
  const std::set<int> goal(to.begin(), to.end());
  std::map<int, std::pair<double, int>> reached;  // distance and where from
  std::priority_queue<std::pair<double, int>, std::vector<std::pair<double, int>>, std::greater<>> queue;
  for (const int v : from) {
    reached[v] = {0, v};
    queue.emplace(0, v);
  }
  while (!queue.empty()) {
    const auto [distance, v] = queue.top();
    queue.pop();
    const int origin = reached.at(v).second;
    if (goal.count(v) > 0) return {node_position(layout, origin), node_position(layout, v)};
    for (const int w : neighbours[static_cast<std::size_t>(v)]) {
      const double total = distance + (node_position(layout, v) - node_position(layout, w)).norm();
      const auto known = reached.find(w);
      if (known != reached.end() && known->second.first <= total) continue;
      reached[w] = {total, origin};
      queue.emplace(total, w);
    }
  }
  return {node_position(layout, from.front()), node_position(layout, to.front())};
}

void require_disc(const PanelLayout& layout, std::size_t panel, const std::string& source)
{
  const auto loops = boundary_loops(layout, static_cast<int>(panel));
  if (loops.empty())
    throw InputError(fmt::format("{}: no seam opens {}: it has no boundary; draw a seam around or through it", source,
                                 describe(layout, panel)));
  if (loops.size() > 1) {
    const auto [from, to] = shortest_link(layout, static_cast<int>(panel), loops[0], loops[1]);
    throw InputError(fmt::format("{}: {} has a hole: it lies between {} and {}; a seam from {} to {} would cut it open",
                                 source, describe(layout, panel), seams_along(layout, loops[0]),
                                 seams_along(layout, loops[1]), place(from), place(to)));
  }
  const TriangleMesh mesh = panel_mesh(layout, static_cast<int>(panel));
  const auto edges = static_cast<int>(edges_of(mesh.triangles, mesh.vertex_count()).size());
  if (mesh.vertex_count() - edges + mesh.triangle_count() != 1)
    throw InputError(fmt::format("{}: {} has a handle; a seam along the handle and one around it would cut it open",
                                 source, describe(layout, panel)));
}

void name_panels(PanelLayout& layout, const SeamPlan& plan)
{
  const SurfaceDistance surface({layout.nodes, node_triangles(layout)});
  const std::vector<int> panel_of = panel_of_triangles(layout);
  std::set<int> named;
  for (const PanelName& name : plan.panels) {
    const int panel = panel_of[static_cast<std::size_t>(surface.closest(name.inside).triangle)];
    if (!named.insert(panel).second)
      throw InputError(
          fmt::format("{}: panel '{}': {} lies in the panel that is called '{}' already: leave one of the "
                      "names out, or draw a seam between them",
                      plan.source, name.name, place(name.inside), layout.panels[static_cast<std::size_t>(panel)].name));
    layout.panels[static_cast<std::size_t>(panel)].name = name.name;
  }
}

}  // namespace

PanelLayout cut_into_panels(const TriangleMesh& mesh, const Geodesics& target, const SeamPlan& plan)
{
  const SeamNetwork network = lay_seams(target, plan, mean_edge_length(mesh));
  const SeamedMesh seamed = snap_to_seams(mesh, target, network, plan);
  PanelLayout layout = split_along(seamed.mesh, seamed.chains);
  name_panels(layout, plan);
  for (std::size_t panel = 0; panel < layout.panels.size(); ++panel) require_disc(layout, panel, plan.source);
  add_walls(layout, network, plan, mean_edge_length(mesh));
  return layout;
}

}  // namespace softform
