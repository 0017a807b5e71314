#include "softform/characters/posed_mesh_file.hpp"

#include <set>

#include <fmt/format.h>

#include "softform/core/error.hpp"
#include "softform/io/mesh_io.hpp"
#include "softform/io/tetgen.hpp"
#include "softform/io/vtk_io.hpp"
#include "softform/mesh/disjoint_sets.hpp"

namespace softform {
namespace {

bool is_vtu(const std::filesystem::path& file) { return file.extension() == ".vtu"; }

// STL has triangles without connectivity: which vertex comes first depends on the shape.
TriangleMesh read_surface(const std::filesystem::path& file)
{
  if (mesh_format(file) == "stl")
    throw InputError(
        fmt::format("{}: STL does not number its vertices, so that poses cannot be told apart from other "
                    "meshes; export OBJ, OFF or PLY",
                    file.string()));
  return read_mesh(file);
}

SimplexMesh<2> read_planar(const std::filesystem::path& file)
{
  if (is_vtu(file)) return read_vtu<2>(file);
  const TriangleMesh surface = read_surface(file);
  SimplexMesh<2> mesh{Vec(2 * surface.vertex_count()), surface.triangles};
  for (int i = 0; i < surface.vertex_count(); ++i) {
    if (surface.vertices(i, 2) != 0)
      throw InputError(
          fmt::format("{}: vertex {} lies at z = {:g}: a body with a thickness lies in z = 0; flatten it, "
                      "or leave the thickness out",
                      file.string(), i, surface.vertices(i, 2)));
    mesh.positions.segment<2>(2 * i) = surface.vertices.row(i).head<2>();
  }
  return mesh;
}

template <class Elements>
void require_same(const Elements& pose, const Elements& rest, Eigen::Index pose_vertices, Eigen::Index rest_vertices,
                  const std::string& pose_file, const std::string& rest_file)
{
  if (pose_vertices != rest_vertices || pose.rows() != rest.rows())
    throw InputError(
        fmt::format("{}: has {} vertices and {} elements, {} has {} and {}: a pose is the same mesh with "
                    "its vertices moved",
                    pose_file, pose_vertices, pose.rows(), rest_file, rest_vertices, rest.rows()));
  for (Eigen::Index e = 0; e < rest.rows(); ++e)
    if (pose.row(e) != rest.row(e))
      throw InputError(
          fmt::format("{}: element {} has other corners than in {}: a pose is the same mesh with its "
                      "vertices moved; keep their order when exporting",
                      pose_file, e, rest_file));
}

template <int dim>
void require_whole(const SimplexMesh<dim>& mesh, const std::string& name)
{
  std::vector<bool> is_used(static_cast<std::size_t>(mesh.vertex_count()), false);
  DisjointSets sets(is_used.size());
  for (int e = 0; e < mesh.element_count(); ++e)
    for (int k = 0; k <= dim; ++k) {
      is_used[static_cast<std::size_t>(mesh.elements(e, k))] = true;
      sets.unite(mesh.elements(e, 0), mesh.elements(e, k));
    }
  std::set<int> parts;
  for (int i = 0; i < mesh.vertex_count(); ++i) {
    if (!is_used[static_cast<std::size_t>(i)])
      throw InputError(fmt::format("{}: vertex {} belongs to no element: delete loose vertices", name, i));
    parts.insert(sets.root(i));
  }
  if (parts.size() > 1)
    throw InputError(fmt::format("{}: the body has {} parts that do not hang together: keep one", name, parts.size()));
}

// At rest, elements that are turned over are the file's fault.
template <int dim>
void require_upright_rest(const SimplexMesh<dim>& mesh, const std::string& name)
{
  try {
    require_upright<dim>({mesh, {}, {"at rest"}, {mesh.positions}, {}}, name);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{} (elements run counter-clockwise, tetrahedra have positive volume)", error.what()));
  }
}

template <int dim>
PosedMesh<dim> from_elements(const std::filesystem::path& rest, const std::vector<PoseFile>& poses, double unit,
                             SimplexMesh<dim> (*read)(const std::filesystem::path&))
{
  PosedMesh<dim> body{read(rest), {}, {}, {}, {}};
  require_whole<dim>(body.rest, rest.string());
  require_upright_rest<dim>(body.rest, rest.string());
  for (const PoseFile& pose : poses) {
    const SimplexMesh<dim> mesh = read(pose.file);
    require_same(mesh.elements, body.rest.elements, mesh.vertex_count(), body.rest.vertex_count(), pose.file.string(),
                 rest.string());
    body.names.push_back(pose.name);
    body.targets.push_back(unit * mesh.positions);
    require_upright<dim>({{unit * body.rest.positions, body.rest.elements}, {}, {pose.name}, {body.targets.back()}, {}},
                         pose.file.string());
  }
  body.rest.positions *= unit;
  return body;
}

PosedMesh<3> from_surfaces(const std::filesystem::path& rest, const std::vector<PoseFile>& poses, double unit,
                           int tetrahedra)
{
  const TriangleMesh surface = read_surface(rest);
  std::vector<TriangleMesh> posed;
  for (const PoseFile& pose : poses) {
    posed.push_back(read_surface(pose.file));
    require_same(posed.back().triangles, surface.triangles, posed.back().vertex_count(), surface.vertex_count(),
                 pose.file.string(), rest.string());
  }
  PosedMesh<3> body;
  body.rest = tetrahedra > 0 ? tetrahedralize_to_count(surface, rest.string(), tetrahedra)
                             : tetrahedralize(surface, rest.string());
  body.rest.positions *= unit;
  require_whole<3>(body.rest, rest.string());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    Vec x = body.rest.positions;
    x.head(3 * surface.vertex_count()) = unit * flatten(posed[i].vertices);
    body.names.push_back(poses[i].name);
    body.targets.push_back(filled_target(body.rest, x));
    require_upright<3>({body.rest, {}, {poses[i].name}, {body.targets.back()}, {}}, poses[i].file.string());
  }
  return body;
}

}  // namespace

template <>
PosedMesh<2> read_posed_mesh<2>(const std::filesystem::path& rest, const std::vector<PoseFile>& poses, double unit, int)
{
  PosedMesh<2> body = from_elements<2>(rest, poses, unit, read_planar);
  body.way = rigid_way<2>(body.rest, body.targets);
  return body;
}

template <>
PosedMesh<3> read_posed_mesh<3>(const std::filesystem::path& rest, const std::vector<PoseFile>& poses, double unit,
                                int tetrahedra)
{
  PosedMesh<3> body =
      is_vtu(rest) ? from_elements<3>(rest, poses, unit, read_vtu<3>) : from_surfaces(rest, poses, unit, tetrahedra);
  body.way = rigid_way<3>(body.rest, body.targets);
  return body;
}

}  // namespace softform
