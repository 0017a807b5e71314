#include "softform/mesh/check.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "softform/core/error.hpp"
#include "softform/mesh/disjoint_sets.hpp"
#include "softform/mesh/remesh.hpp"
#include "softform/mesh/self_intersections.hpp"

namespace softform {
namespace {

/// How often an edge is run through from its lower to its higher vertex and back, and its first and last triangle.
struct EdgeUse {
  int forward = 0, backward = 0, first = -1, last = -1;
};

class Checker {
 public:
  explicit Checker(const TriangleMesh& mesh) : mesh_(mesh)
  {
    for (int t = 0; t < mesh.triangle_count(); ++t) {
      for (int k = 0; k < 3; ++k) {
        const int a = mesh.triangles(t, k), b = mesh.triangles(t, (k + 1) % 3);
        EdgeUse& use = edges_[std::minmax(a, b)];
        ++(a < b ? use.forward : use.backward);
        if (use.first < 0) use.first = t;
        use.last = t;
      }
    }
  }

  MeshReport run()
  {
    describe();
    check_triangles();
    if (!has(MeshProblemKind::DegenerateTriangle) && !has(MeshProblemKind::DuplicateTriangle)) check_edges();
    if (report_.problems.empty()) check_vertex_fans();
    check_whole();
    std::stable_sort(report_.problems.begin(), report_.problems.end(),
                     [](const MeshProblem& a, const MeshProblem& b) { return a.kind < b.kind; });
    return report_;
  }

 private:
  bool has(MeshProblemKind kind) const
  {
    return std::any_of(report_.problems.begin(), report_.problems.end(),
                       [kind](const MeshProblem& problem) { return problem.kind == kind; });
  }

  /// Only the first element of a kind makes a message, the others are counted.
  template <class Message>
  void add(MeshProblemKind kind, const Message& message)
  {
    for (MeshProblem& problem : report_.problems) {
      if (problem.kind != kind) continue;
      ++problem.count;
      return;
    }
    report_.problems.push_back({kind, 1, message()});
  }

  auto corner(int t, int k) const { return mesh_.vertices.row(mesh_.triangles(t, k)); }

  void describe()
  {
    report_.vertices = mesh_.vertex_count();
    report_.triangles = mesh_.triangle_count();
    report_.edges = static_cast<int>(edges_.size());
    if (report_.vertices > 0) {
      report_.lower_corner = mesh_.vertices.colwise().minCoeff();
      report_.upper_corner = mesh_.vertices.colwise().maxCoeff();
    }
    report_.volume = enclosed_volume(mesh_);
    report_.smallest_angle = report_.triangles > 0 ? smallest_angle(mesh_) : 0;
    report_.components = count_components();
    if (report_.triangles < 4)
      add(MeshProblemKind::TooFewTriangles, [&] {
        return fmt::format("{} triangles enclose nothing (a closed surface has at least 4); use a closed surface",
                           report_.triangles);
      });
  }

  /// Components of the vertices that triangles use.
  int count_components()
  {
    DisjointSets sets(static_cast<std::size_t>(mesh_.vertex_count()));
    for (const auto& [edge, use] : edges_) sets.unite(edge.first, edge.second);
    std::set<int> roots;
    for (int t = 0; t < mesh_.triangle_count(); ++t) roots.insert(sets.root(mesh_.triangles(t, 0)));
    return static_cast<int>(roots.size());
  }

  void check_triangles()
  {
    std::vector<bool> used(static_cast<std::size_t>(mesh_.vertex_count()), false);
    std::map<std::array<int, 3>, int> known;
    for (int t = 0; t < mesh_.triangle_count(); ++t) {
      std::array<int, 3> corners{mesh_.triangles(t, 0), mesh_.triangles(t, 1), mesh_.triangles(t, 2)};
      for (const int v : corners) used[static_cast<std::size_t>(v)] = true;
      check_area(t);
      std::sort(corners.begin(), corners.end());
      const auto [first, is_new] = known.try_emplace(corners, t);
      if (!is_new)
        add(MeshProblemKind::DuplicateTriangle, [&, other = first->second] {
          return fmt::format("triangles {} and {} have the same corners; delete one of them", other, t);
        });
    }
    for (int v = 0; v < mesh_.vertex_count(); ++v) {
      if (!mesh_.vertices.row(v).allFinite())
        add(MeshProblemKind::NotFinite,
            [&] { return fmt::format("vertex {} has a coordinate that is not finite; repair the export", v); });
      if (!used[static_cast<std::size_t>(v)])
        add(MeshProblemKind::UnusedVertex,
            [&] { return fmt::format("vertex {} belongs to no triangle; delete loose vertices", v); });
    }
  }

  /// Degenerate: no area beyond the round-off of its longest edge.
  void check_area(int t)
  {
    const Vec3 a = corner(t, 1) - corner(t, 0), b = corner(t, 2) - corner(t, 0);
    const double longest = std::max({a.squaredNorm(), b.squaredNorm(), (a - b).squaredNorm()});
    if (a.cross(b).norm() <= 1e-12 * longest)
      add(MeshProblemKind::DegenerateTriangle, [&] {
        return fmt::format("triangle {} (vertices {}, {}, {}) has no area; merge its corners or collapse an edge", t,
                           mesh_.triangles(t, 0), mesh_.triangles(t, 1), mesh_.triangles(t, 2));
      });
  }

  void check_edges()
  {
    for (const auto& [edge, use] : edges_) {
      const auto [a, b] = edge;
      const int triangles = use.forward + use.backward;
      if (triangles > 2)
        add(MeshProblemKind::NonManifoldEdge, [&, a = a, b = b, &use = use] {
          return fmt::format(
              "edge {}-{} has {} triangles (one is triangle {}); remove inner walls until every edge has 2", a, b,
              triangles, use.first);
        });
      else if (triangles == 1)
        add(MeshProblemKind::OpenEdge, [&, a = a, b = b, &use = use] {
          return fmt::format("edge {}-{} of triangle {} is open; fill the hole", a, b, use.first);
        });
      else if (use.forward != 1)
        add(MeshProblemKind::InconsistentOrientation, [&, a = a, b = b, &use = use] {
          return fmt::format("triangles {} and {} face opposite sides across edge {}-{}; make the normals consistent",
                             use.first, use.last, a, b);
        });
    }
  }

  /// On a manifold the triangles around a vertex make one fan: as many as can be reached from the first.
  void check_vertex_fans()
  {
    std::vector<std::map<int, int>> next(static_cast<std::size_t>(mesh_.vertex_count()));
    for (int t = 0; t < mesh_.triangle_count(); ++t)
      for (int k = 0; k < 3; ++k)
        next[static_cast<std::size_t>(mesh_.triangles(t, k))][mesh_.triangles(t, (k + 1) % 3)] =
            mesh_.triangles(t, (k + 2) % 3);
    for (int v = 0; v < mesh_.vertex_count(); ++v) {
      const auto& fan = next[static_cast<std::size_t>(v)];
      std::size_t reached = 0;
      int at = fan.begin()->first;
      do {
        at = fan.at(at);
        ++reached;
      } while (at != fan.begin()->first);
      if (reached != fan.size())
        add(MeshProblemKind::NonManifoldVertex,
            [&] { return fmt::format("vertex {} joins parts of the surface that touch only there; split it", v); });
    }
  }

  void check_whole()
  {
    if (report_.components > 1)
      add(MeshProblemKind::SeveralComponents,
          [&] { return fmt::format("the surface has {} separate parts; keep one", report_.components); });
    const bool closed_manifold =
        report_.problems.empty() || (report_.problems.size() == 1 && has(MeshProblemKind::SeveralComponents));
    if (!closed_manifold) return;

    report_.genus = report_.components - (report_.vertices - report_.edges + report_.triangles) / 2;
    if (*report_.genus > 0)
      report_.notes.push_back(fmt::format("the surface has {} tunnels (genus {})", *report_.genus, *report_.genus));
    if (report_.smallest_angle < 10)
      report_.notes.push_back(
          fmt::format("the smallest angle is {:.2g} degrees: results are poor and steps slow below "
                      "10; remesh",
                      report_.smallest_angle));
    if (!(report_.volume > 0))
      add(MeshProblemKind::InvertedOrientation, [&] {
        return fmt::format("the triangles face inwards (triangle 0 too; volume {:.3g}); flip the normals",
                           report_.volume);
      });
    const auto pairs = self_intersections(mesh_);
    report_.self_intersections = static_cast<int>(pairs.size());
    for (const auto& [a, b] : pairs)
      add(MeshProblemKind::SelfIntersection, [&, a = a, b = b] {
        return fmt::format("triangles {} and {} cut each other; repair the mesh or remesh it", a, b);
      });
  }

  const TriangleMesh& mesh_;
  std::map<std::pair<int, int>, EdgeUse> edges_;
  MeshReport report_;
};

}  // namespace

MeshReport check_mesh(const TriangleMesh& mesh) { return Checker(mesh).run(); }

void require_closed_surface(const TriangleMesh& mesh, const std::string& name)
{
  const MeshReport report = check_mesh(mesh);
  if (report.usable()) return;
  std::string text;
  for (const MeshProblem& problem : report.problems)
    text += fmt::format("{}{}: {}{}", text.empty() ? "" : "\n", name, problem.message,
                        problem.count > 1 ? fmt::format(" ({} such)", problem.count) : "");
  throw InputError(text);
}

}  // namespace softform
