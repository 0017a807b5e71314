#include "softform/io/mesh_io.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include <CGAL/IO/polygon_soup_io.h>
#include <fmt/format.h>

#include "softform/core/error.hpp"
#include "softform/io/atomic_write.hpp"
#include "softform/mesh/cgal_mesh_internal.hpp"

namespace softform {
namespace {

using Polygon = std::vector<std::size_t>;

/// CGAL's readers give up at a number that they cannot read without saying where: finds the line for the message.
std::string non_finite_hint(const std::filesystem::path& path)
{
  std::ifstream file(path);
  std::string line;
  for (int number = 1; std::getline(file, line) && number < 10'000'000; ++number) {
    std::istringstream words(line);
    for (std::string word; words >> word;) {
      std::transform(word.begin(), word.end(), word.begin(), [](unsigned char c) { return std::tolower(c); });
      word.erase(0, word.find_first_not_of("+-"));
      if (word == "nan" || word == "inf" || word == "infinity")
        return fmt::format("line {} holds a coordinate that is not finite ('{}')", number, line);
    }
  }
  return {};
}

void require_readable(const std::filesystem::path& path)
{
  std::error_code error;
  if (!std::filesystem::exists(path, error))
    throw InputError(fmt::format("{}: no such file; check the path", path.string()));
  if (!std::filesystem::is_regular_file(path, error) || !std::ifstream(path))
    throw InputError(fmt::format("{}: is no readable file; check the path and its permissions", path.string()));
  if (std::filesystem::file_size(path, error) == 0)
    throw InputError(fmt::format("{}: the file is empty; export the mesh again", path.string()));
}

Positions checked_vertices(const std::vector<cgal::Point>& points, const std::string& name)
{
  Positions vertices(static_cast<Eigen::Index>(points.size()), 3);
  for (Eigen::Index i = 0; i < vertices.rows(); ++i) {
    const auto& p = points[static_cast<std::size_t>(i)];
    vertices.row(i) << p.x(), p.y(), p.z();
    if (!vertices.row(i).allFinite())
      throw InputError(fmt::format("{}: vertex {} has a coordinate that is not finite ({}, {}, {}); repair the export",
                                   name, i, p.x(), p.y(), p.z()));
  }
  return vertices;
}

Triangles checked_triangles(const std::vector<Polygon>& polygons, const Positions& vertices, const std::string& name)
{
  std::vector<Eigen::RowVector3i> triangles;
  triangles.reserve(polygons.size());
  for (std::size_t f = 0; f < polygons.size(); ++f) {
    const Polygon& polygon = polygons[f];
    if (polygon.size() < 3 || polygon.size() > 4)
      throw InputError(
          fmt::format("{}: face {} has {} corners; triangulate the mesh before exporting it", name, f, polygon.size()));
    for (const std::size_t corner : polygon)
      if (corner >= static_cast<std::size_t>(vertices.rows()))
        throw InputError(fmt::format("{}: face {} names vertex {} (counted from 0) of only {}; repair the export", name,
                                     f, static_cast<std::ptrdiff_t>(corner), vertices.rows()));
    const auto corner = [&](std::size_t k) { return static_cast<int>(polygon[k % polygon.size()]); };
    const auto length = [&](std::size_t k) { return (vertices.row(corner(k)) - vertices.row(corner(k + 2))).norm(); };
    const std::size_t first = polygon.size() == 4 && length(1) < length(0) ? 1 : 0;
    triangles.emplace_back(corner(first), corner(first + 1), corner(first + 2));
    if (polygon.size() == 4) triangles.emplace_back(corner(first), corner(first + 2), corner(first + 3));
  }
  Triangles result(static_cast<Eigen::Index>(triangles.size()), 3);
  for (std::size_t t = 0; t < triangles.size(); ++t) result.row(static_cast<Eigen::Index>(t)) = triangles[t];
  return result;
}

}  // namespace

std::string mesh_format(const std::filesystem::path& path)
{
  std::string format = path.extension().string();
  std::transform(format.begin(), format.end(), format.begin(), [](unsigned char c) { return std::tolower(c); });
  if (format != ".off" && format != ".obj" && format != ".ply" && format != ".stl")
    throw InputError(fmt::format("{}: '{}' is no mesh format known here; use .off, .obj, .ply or .stl", path.string(),
                                 path.extension().string()));
  return format.substr(1);
}

TriangleMesh read_mesh(const std::filesystem::path& path)
{
  const std::string format = mesh_format(path);
  require_readable(path);

  std::vector<cgal::Point> points;
  std::vector<Polygon> polygons;
  bool ok = false;
  try {
    ok = CGAL::IO::read_polygon_soup(path.string(), points, polygons);
  } catch (const std::exception&) {  // CGAL's assertions, std::length_error of absurd counts, std::bad_alloc
  }
  if (!ok || points.empty() || polygons.empty()) {
    const std::string hint = non_finite_hint(path);
    throw InputError(fmt::format("{}: {}; repair the export", path.string(),
                                 hint.empty() ? "is no complete " + format + " file with vertices and faces" : hint));
  }
  TriangleMesh mesh;
  mesh.vertices = checked_vertices(points, path.string());
  mesh.triangles = checked_triangles(polygons, mesh.vertices, path.string());
  return mesh;
}

void write_mesh(const std::filesystem::path& path, const TriangleMesh& mesh)
{
  const std::string format = mesh_format(path);
  std::vector<cgal::Point> points;
  for (int i = 0; i < mesh.vertex_count(); ++i) points.push_back(cgal::point(mesh.vertices, i));
  std::vector<Polygon> polygons;
  for (int t = 0; t < mesh.triangle_count(); ++t)
    polygons.emplace_back(mesh.triangles.row(t).begin(), mesh.triangles.row(t).end());
  const bool binary = format == "ply" || format == "stl";
  write_atomically(path, [&](const std::filesystem::path& temporary) {
    return CGAL::IO::write_polygon_soup(temporary.string(), points, polygons,
                                        CGAL::parameters::stream_precision(17).use_binary_mode(binary));
  });
}

}  // namespace softform
