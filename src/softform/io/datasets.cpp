#include "softform/io/datasets.hpp"

#include <algorithm>
#include <cstdlib>
#include <fstream>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "softform/core/error.hpp"
#include "softform/io/mesh_io.hpp"
#include "softform/mesh/shapes.hpp"

namespace softform {
namespace {

using Json = nlohmann::json;

void allow_only(const Json& object, std::initializer_list<const char*> keys)
{
  for (const auto& [key, value] : object.items())
    if (std::find(keys.begin(), keys.end(), key) == keys.end()) throw InputError("has the unknown key '" + key + "'");
}

Dataset dataset_from(const Json& json, const std::filesystem::path& folder)
{
  allow_only(json, {"id", "vertices", "origin", "shrink_wrap", "model", "unit", "credit", "licence"});
  Dataset dataset{json.at("id"),     json.at("vertices"), {}, {}, {}, json.at("unit"),
                  json.at("credit"), json.at("licence")};
  if (json.contains("model")) dataset.model = folder / json["model"].get<std::string>();
  if (json.contains("origin")) {
    const Json& origin = json["origin"];
    allow_only(origin, {"package", "archive", "member", "sha256"});
    dataset.origin = {origin.at("package"), origin.at("archive"), origin.at("member"), origin.at("sha256")};
  }
  if (json.contains("shrink_wrap")) {
    const Json& wrap = json["shrink_wrap"];
    allow_only(wrap, {"alpha", "offset", "why"});
    dataset.shrink_wrap = {wrap.at("alpha"), wrap.at("offset")};
  }
  return dataset;
}

}  // namespace

std::vector<Dataset> read_manifest(const std::filesystem::path& manifest)
{
  std::ifstream file(manifest);
  if (!file) throw InputError(fmt::format("{}: no such file; run this from a checkout of softform", manifest.string()));
  try {
    const Json json = Json::parse(file);
    allow_only(json, {"datasets"});
    std::vector<Dataset> datasets;
    for (const Json& entry : json.at("datasets")) datasets.push_back(dataset_from(entry, manifest.parent_path()));
    return datasets;
  } catch (const std::exception& error) {
    throw InputError(fmt::format("{}: {}; restore the file from the repository", manifest.string(), error.what()));
  }
}

std::filesystem::path default_manifest() { return SOFTFORM_SOURCE_DIR "/datasets/manifest.json"; }

std::filesystem::path dataset_cache()
{
  const char* chosen = std::getenv("SOFTFORM_CACHE");
  return chosen != nullptr && *chosen != '\0' ? chosen : SOFTFORM_SOURCE_DIR "/cache/datasets";
}

std::filesystem::path dataset_file(const std::filesystem::path& cache, const std::string& id, int vertices)
{
  return cache / fmt::format("{}_{}.off", id, vertices);
}

TriangleMesh procedural_dataset(const std::string& id, int vertices)
{
  if (id == "cube") return cube(1, vertices);
  if (id == "bumpsphere") return bumpsphere(1, vertices);
  if (id == "sphere") return irregular_sphere(1, vertices);
  throw InputError(fmt::format("'{}' is no shape of our own; there are cube, bumpsphere and sphere", id));
}

TriangleMesh load_dataset(const std::string& id, int vertices)
{
  const auto path = dataset_file(dataset_cache(), id, vertices);
  if (std::filesystem::exists(path)) return read_mesh(path);

  const auto datasets = read_manifest(default_manifest());
  std::string known;
  for (const Dataset& dataset : datasets) {
    known += (known.empty() ? "" : ", ") + dataset.id;
    if (dataset.id != id) continue;
    if (!dataset.origin && !dataset.model) return procedural_dataset(id, vertices);
    throw InputError(fmt::format("{}: not prepared yet; run `softform-datasets prepare {}` (sizes: {} vertices)",
                                 path.string(), id, fmt::join(dataset.vertices, ", ")));
  }
  throw InputError(fmt::format("there is no dataset '{}'; there are {}", id, known));
}

}  // namespace softform
