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
#include "softform/mesh/check.hpp"

namespace softform::cli {
namespace {

namespace fs = std::filesystem;

Vec areas(const TriangleMesh& mesh)
{
  Vec result(mesh.triangle_count());
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    const auto corner = [&](int k) -> Vec3 { return mesh.vertices.row(mesh.triangles(t, k)); };
    result[t] = 0.5 * (corner(1) - corner(0)).cross(corner(2) - corner(0)).norm();
  }
  return result;
}

}  // namespace

double metres_per_unit(const TriangleMesh& mesh, const std::string& file, std::optional<double> size)
{
  const double units = diameter(mesh.vertices);
  if (!size)
    spdlog::info("{}: without --size its numbers are taken as millimetres: it measures {:.4g} mm", file, units);
  return size ? *size / units : 1e-3;
}

TriangleMesh read_closed_mesh(const std::string& file, std::optional<double> size)
{
  TriangleMesh mesh = read_mesh(file);
  require_closed_surface(mesh, file);
  mesh.vertices *= metres_per_unit(mesh, file, size);
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

void write_trace(const std::string& folder, const Report& report)
{
  CsvTable table({{"iteration"}, {"objective"}, {"stationarity"}, {"infeasibility"}, {"step_norm"}, {"elapsed", "s"}});
  for (const Iterate& it : report.trace)
    table.add_row({double(it.k), it.objective, it.stationarity, it.infeasibility, it.step_norm, it.elapsed_s});
  write_text(fs::path(folder) / "trace.csv", table.text());
}

Field stretch_field(const TriangleMesh& deformed, const TriangleMesh& rest)
{
  return {"stretch [1]", (areas(deformed).array() / areas(rest).array()).sqrt().matrix()};
}

}  // namespace softform::cli
