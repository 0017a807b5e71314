#include "files.hpp"

#include <unistd.h>

#include <cmath>
#include <filesystem>

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "softform/core/error.hpp"
#include "softform/io/mesh_io.hpp"
#include "softform/io/text_file.hpp"
#include "softform/io/vtk_io.hpp"
#include "softform/mesh/check.hpp"

namespace softform::cli {
namespace {

namespace fs = std::filesystem;

Vec areas(ConstVec x, const Triangles& triangles)
{
  Vec result(triangles.rows());
  for (int t = 0; t < triangles.rows(); ++t) {
    const Vec3 origin = vertex(x, triangles(t, 0));
    result[t] = 0.5 * (vertex(x, triangles(t, 1)) - origin).cross(vertex(x, triangles(t, 2)) - origin).norm();
  }
  return result;
}

}  // namespace

TriangleMesh read_closed_mesh(const std::string& file, std::optional<double> size)
{
  TriangleMesh mesh = read_mesh(file);
  require_closed_surface(mesh, file);
  const double units = diameter(mesh.vertices);
  mesh.vertices *= size ? *size / units : 1e-3;
  if (!size)
    spdlog::info("{}: without --size its numbers are taken as millimetres: it measures {:.4g} mm", file, units);
  return mesh;
}

void require_writable(const std::string& folder)
{
  fs::path existing = fs::absolute(folder).lexically_normal();
  while (!fs::exists(existing)) existing = existing.parent_path();
  if (!fs::is_directory(existing))
    throw InputError(fmt::format("--out: {} is a file, not a folder: give another name", existing.string()));
  if (access(existing.c_str(), W_OK) != 0)
    throw InputError(fmt::format("--out: {} cannot be written to: give another folder", existing.string()));
}

void write_metrics(const std::string& folder, std::vector<Metric> metrics)
{
  std::erase_if(metrics, [](const Metric& metric) { return !std::isfinite(metric.value); });
  write_text(fs::path(folder) / "metrics.csv", metrics_csv(metrics));
}

void write_state(const std::string& file, ConstVec x, ConstVec rest_positions, const Triangles& triangles)
{
  const Vec stretch = (areas(x, triangles).array() / areas(rest_positions, triangles).array()).sqrt();
  write_vtp(file, {unflatten(x), triangles}, {{}, {{"stretch [1]", stretch}}});
}

}  // namespace softform::cli
