#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "softform/mesh/simplex_mesh.hpp"
#include "softform/mesh/triangle_mesh.hpp"

namespace softform {

/// Values on the vertices or triangles of a surface: one row each, one column (scalars) or three (vectors).
struct Field {
  std::string name;  ///< with its unit, for example "distance [m]"
  Eigen::MatrixXd values;
};

struct SurfaceFields {
  std::vector<Field> on_vertices;
  std::vector<Field> on_triangles;

  /// The field of that name, on vertices first. Throws InputError naming the fields that there are.
  const Eigen::MatrixXd& at(const std::string& name) const;
};

struct SurfaceWithFields {
  TriangleMesh mesh;
  SurfaceFields fields;
};

/// Writes a surface for ParaView (.vtp: binary, double precision). The file appears under its name only when complete.
/// Throws InputError when it cannot be written. Precondition: fields have one row a vertex or triangle.
void write_vtp(const std::filesystem::path& path, const TriangleMesh& mesh, const SurfaceFields& fields = {});

/// Writes a solid of tetrahedra or of triangles in the plane for ParaView (.vtu), with fields on vertices and elements.
template <int dim>
void write_vtu(const std::filesystem::path& path, const SimplexMesh<dim>& mesh,
               const std::vector<Field>& on_vertices = {}, const std::vector<Field>& on_elements = {});

/// Reads what write_vtp wrote. Throws InputError for a missing or unreadable file and for polygons beyond triangles.
SurfaceWithFields read_vtp(const std::filesystem::path& path);

/// Reads a solid of tetrahedra, or of triangles in the plane z = 0, from .vtu; fields are left out. The numbers are
/// taken as they are. Throws InputError for a missing or unreadable file, cells of another kind, coordinates that are
/// not finite and, in the plane, points off it.
template <int dim>
SimplexMesh<dim> read_vtu(const std::filesystem::path& path);

/// Writes a series for ParaView (.pvd): a parameter value (time, step, pressure) and a file for each entry; the files
/// are named relative to the folder of `path`.
void write_pvd(const std::filesystem::path& path, const std::vector<std::pair<double, std::filesystem::path>>& entries);

}  // namespace softform
