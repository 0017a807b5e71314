#include "prepare.hpp"

#include <fstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include "fetch.hpp"
#include "softform/core/error.hpp"
#include "softform/io/mesh_io.hpp"
#include "softform/io/model_file.hpp"
#include "softform/io/sha256.hpp"
#include "softform/io/text_file.hpp"
#include "softform/mesh/check.hpp"
#include "softform/mesh/remesh.hpp"

namespace softform {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// Raised whenever prepared meshes come out differently, so that older ones in a cache are made anew.
constexpr int recipe = 1;

fs::path stamp_file(const fs::path& mesh) { return fs::path(mesh).replace_extension(".json"); }

/// The stamp beside a mesh; an empty object when there is none or it cannot be read.
Json read_stamp(const fs::path& mesh)
{
  std::ifstream file(stamp_file(mesh));
  const Json stamp = Json::parse(file, nullptr, false);
  return stamp.is_object() ? stamp : Json::object();
}

bool is_prepared(const fs::path& mesh, const std::string& raw_sha256)
{
  const Json stamp = read_stamp(mesh);
  return fs::exists(mesh) && stamp.value("recipe", 0) == recipe && stamp.value("raw_sha256", "") == raw_sha256 &&
         stamp.value("sha256", "") == sha256_of_file(mesh);
}

TriangleMesh closed_surface(const Dataset& dataset, const fs::path& raw)
{
  const TriangleMesh mesh = read_mesh(raw);
  if (!dataset.shrink_wrap) return repaired(mesh);
  const double diagonal = (mesh.vertices.colwise().maxCoeff() - mesh.vertices.colwise().minCoeff()).norm();
  return repaired(shrink_wrapped(mesh, diagonal / dataset.shrink_wrap->alpha, diagonal / dataset.shrink_wrap->offset));
}

/// What a dataset is made from.
class Source {
 public:
  Source(const Dataset& dataset, const PreparePaths& paths) : dataset_(dataset)
  {
    if (dataset.origin) file_ = raw_file(dataset, paths.cache, paths.from);
    if (dataset.model) file_ = *dataset.model;
  }

  /// Of the file, empty for an exact shape.
  std::string sha256() const { return file_.empty() ? "" : sha256_of_file(file_); }

  TriangleMesh mesh(int vertices)
  {
    if (dataset_.model) return mesh_model(read_model(file_), vertices);
    if (!dataset_.origin) return procedural_dataset(dataset_.id, vertices);
    if (surface_.triangle_count() == 0) surface_ = closed_surface(dataset_, file_);
    return remesh_to_vertex_count(surface_, vertices);
  }

 private:
  const Dataset& dataset_;
  fs::path file_;
  TriangleMesh surface_;  ///< of a third party's file, once closed
};

std::string shortcoming(const TriangleMesh& mesh, int vertices)
{
  const MeshReport report = check_mesh(mesh);
  if (!report.usable()) return report.problems.front().message;
  if (report.vertices != vertices) return fmt::format("{} vertices instead of {}", report.vertices, vertices);
  if (report.genus != 0) return "a genus other than 0";
  if (!(report.smallest_angle > 20)) return fmt::format("a smallest angle of {:.1f} degrees", report.smallest_angle);
  return {};
}

}  // namespace

void prepare(const Dataset& dataset, const PreparePaths& paths)
{
  Source source(dataset, paths);
  const std::string raw_sha256 = source.sha256();
  for (const int vertices : dataset.vertices) {
    const fs::path target = dataset_file(paths.cache, dataset.id, vertices);
    if (is_prepared(target, raw_sha256)) {
      spdlog::info("{} is there", target.string());
      continue;
    }
    spdlog::info("preparing {} with {} vertices", dataset.id, vertices);
    const TriangleMesh mesh = source.mesh(vertices);
    if (const std::string reason = shortcoming(mesh, vertices); !reason.empty())
      throw InputError(
          fmt::format("{} with {} vertices came out with {}; use another input or size", dataset.id, vertices, reason));
    write_mesh(target, mesh);
    const Json stamp{{"recipe", recipe},     {"raw_sha256", raw_sha256}, {"sha256", sha256_of_file(target)},
                     {"unit", dataset.unit}, {"credit", dataset.credit}, {"licence", dataset.licence}};
    write_text(stamp_file(target), stamp.dump(2) + "\n");
  }
}

std::string shortcoming(const Dataset& dataset, int vertices, const fs::path& cache)
{
  const fs::path path = dataset_file(cache, dataset.id, vertices);
  if (!fs::exists(path)) return "not prepared";
  if (read_stamp(path).value("sha256", "") != sha256_of_file(path)) return "changed since it was prepared";
  return shortcoming(read_mesh(path), vertices);
}

}  // namespace softform
