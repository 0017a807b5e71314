// Purpose: the quantities of (4.12) and (4.14) on a computed mesh (thesis section 4.4.1, figure 4.4): length l and
// dihedral angle theta of an edge on the target and on the simulated balloon, and the forces on a vertex of the latter.
// Claim: at equilibrium the membrane forces of a vertex's triangles and its pressure force add up to nothing.

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include <Eigen/Geometry>

#include "softform/balloons/balloon_design.hpp"
#include "softform/experiment/experiment.hpp"
#include "softform/experiment/run.hpp"
#include "softform/fem/enclosed_volume.hpp"
#include "softform/fem/membrane.hpp"
#include "softform/io/datasets.hpp"
#include "softform/materials/material_file.hpp"
#include "softform/objectives/edge_dihedral.hpp"

namespace {

using namespace softform;

Vec3 point(const TriangleMesh& mesh, int i) { return mesh.vertices.row(i); }

double angle_of(const TriangleMesh& mesh, const Edge& e)
{
  return dihedral_angle(point(mesh, e.start), point(mesh, e.end), point(mesh, e.left), point(mesh, e.right));
}

double length_of(const TriangleMesh& mesh, const Edge& e) { return (point(mesh, e.end) - point(mesh, e.start)).norm(); }

// The angle between the normals of the edge's triangles, without a sign: another way to the dihedral angle.
double angle_between_normals(const TriangleMesh& mesh, const Edge& e)
{
  const Vec3 a = point(mesh, e.start), b = point(mesh, e.end);
  const Vec3 n1 = (b - a).cross(point(mesh, e.left) - a), n2 = (a - b).cross(point(mesh, e.right) - b);
  return std::acos(n1.dot(n2) / (n1.norm() * n2.norm()));
}

// The sharpest edge of the target: it shows its angle.
Edge sharpest_edge(const TriangleMesh& mesh)
{
  const auto edges = edges_of(mesh.triangles, mesh.vertex_count());
  return *std::max_element(edges.begin(), edges.end(),
                           [&](const Edge& a, const Edge& b) { return angle_of(mesh, a) < angle_of(mesh, b); });
}

// The triangles around an edge, three rows each; `kind` is 1 for the two at the edge, start, end, third corner first.
void write_patch(Run& run, const std::string& name, const TriangleMesh& mesh, const Edge& e)
{
  CsvTable& table = run.series(name, {{"kind"}, {"x", "m"}, {"y", "m"}, {"z", "m"}});
  const auto add = [&](int kind, int i) {
    table.add_row({double(kind), point(mesh, i).x(), point(mesh, i).y(), point(mesh, i).z()});
  };
  for (const int i : {e.start, e.end, e.left, e.end, e.start, e.right}) add(1, i);
  for (const auto& t : mesh.triangles.rowwise()) {
    const auto has = [&](int i) { return t[0] == i || t[1] == i || t[2] == i; };
    if ((has(e.start) || has(e.end)) && !(has(e.start) && has(e.end)))
      for (const int i : t) add(0, i);
  }
}

// The force of every triangle around a vertex on it, and the pressure's: rows of (kind, triangle's corners, force).
double write_forces(Run& run, const BalloonDesign& design, const BalloonOptions& options,
                    const std::shared_ptr<const Material>& material, int vertex)
{
  CsvTable& table = run.series("forces", {{"kind"},
                                          {"ax", "m"},
                                          {"ay", "m"},
                                          {"az", "m"},
                                          {"bx", "m"},
                                          {"by", "m"},
                                          {"bz", "m"},
                                          {"cx", "m"},
                                          {"cy", "m"},
                                          {"cz", "m"},
                                          {"fx", "N"},
                                          {"fy", "N"},
                                          {"fz", "N"}});
  const TriangleMesh& inflated = design.inflated;
  const Vec x = flatten(inflated.vertices), X = flatten(design.rest.vertices);
  Vec3 membrane_force = Vec3::Zero();
  Vec g;
  for (const auto& t : inflated.triangles.rowwise()) {
    if (t[0] != vertex && t[1] != vertex && t[2] != vertex) continue;
    const Membrane triangle(t, inflated.vertex_count(), material, Vec::Constant(1, options.thickness));
    triangle.gradient(x, X, g);
    const Vec3 f = -g.segment<3>(3 * vertex), a = point(inflated, t[0]), b = point(inflated, t[1]),
               c = point(inflated, t[2]);
    table.add_row({0, a.x(), a.y(), a.z(), b.x(), b.y(), b.z(), c.x(), c.y(), c.z(), f.x(), f.y(), f.z()});
    membrane_force += f;
  }
  EnclosedVolume(inflated.triangles, inflated.vertex_count()).gradient(x, g);
  const Vec3 pressure_force = design.pressure * g.segment<3>(3 * vertex), p = point(inflated, vertex);
  table.add_row({1, p.x(), p.y(), p.z(), p.x(), p.y(), p.z(), p.x(), p.y(), p.z(), pressure_force.x(),
                 pressure_force.y(), pressure_force.z()});
  return (membrane_force + pressure_force).norm() / pressure_force.norm();
}

void show_quantities(Run& run)
{
  // 1. A bumpsphere and its balloon.
  const TriangleMesh target = scale_to_diameter(load_dataset("bumpsphere", run.by_size(1000, 3265)), 0.146);
  const BalloonOptions options;
  const std::shared_ptr<const Material> material = load_material("silicone");
  run.step("designing the bumpsphere");
  const auto observer = run.observer();
  const BalloonDesign design = design_balloon(target, material, options, [&](const BalloonProgress& progress) {
    return progress.iterate == nullptr || observer(*progress.iterate);
  });

  // 2. Length and angle of one edge, on both meshes.
  const Edge edge = sharpest_edge(target);
  write_patch(run, "target", target, edge);
  write_patch(run, "simulation", design.inflated, edge);
  run.metric("target_length", length_of(target, edge), "m");
  run.metric("target_angle", angle_of(target, edge), "1");
  run.metric("length", length_of(design.inflated, edge), "m");
  run.metric("angle", angle_of(design.inflated, edge), "1");
  run.metric("target_angle_to_that_between_normals", angle_of(target, edge) / angle_between_normals(target, edge), "1");
  run.metric("angle_to_that_between_normals",
             angle_of(design.inflated, edge) / angle_between_normals(design.inflated, edge), "1");

  // 3. The forces on the vertex where the edge starts.
  run.metric("unbalanced_force", write_forces(run, design, options, material, edge.start), "1");
  run.metric("negative_eigenvalues", design.negative_eigenvalues, "1");
}

}  // namespace

int main(int argc, char** argv)
{
  return softform::run_experiment(
      argc, argv, {"fig_4_4", "4.4.1", "At equilibrium, membrane and pressure forces of a vertex cancel.", {0.2, 0.5}},
      show_quantities);
}
