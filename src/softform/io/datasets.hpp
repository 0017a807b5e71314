#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "softform/mesh/triangle_mesh.hpp"

namespace softform {

/// Where a third party's mesh comes from: a file in a .tar.gz in a Debian package.
struct DatasetOrigin {
  std::string package, archive, member;
  std::string sha256;  ///< of the file as it comes

  /// The name under which --from looks for it.
  std::string file_name() const { return std::filesystem::path(member).filename().string(); }
};

/// Shrink-wrapping before remeshing: lengths as fractions 1/alpha, 1/offset of the bounding box's diagonal.
struct ShrinkWrap {
  double alpha, offset;
};

/// An entry of datasets/manifest.json.
struct Dataset {
  std::string id;
  std::vector<int> vertices;            ///< the sizes that are prepared; the thesis' first
  std::optional<DatasetOrigin> origin;  ///< nothing for shapes of our own
  std::optional<ShrinkWrap> shrink_wrap;
  std::optional<std::filesystem::path> model;  ///< description of an implicit model of our own, see io/model_file.hpp
  std::string unit, credit, licence;
};

/// The datasets of the manifest. Throws InputError when it is missing or says something unknown.
std::vector<Dataset> read_manifest(const std::filesystem::path& manifest);

/// The manifest of this checkout.
std::filesystem::path default_manifest();

/// Where prepared meshes are kept: $SOFTFORM_CACHE, else cache/datasets of this checkout.
std::filesystem::path dataset_cache();

/// <cache>/<id>_<vertices>.off
std::filesystem::path dataset_file(const std::filesystem::path& cache, const std::string& id, int vertices);

/// The exact shape of that id (cube, bumpsphere, sphere) at any vertex count; see mesh/shapes.hpp.
/// Throws InputError for another id.
TriangleMesh procedural_dataset(const std::string& id, int vertices);

/// A prepared mesh from the cache, in the manifest's unit; an exact shape that is not there is made.
/// Throws InputError that says how to prepare it when another mesh is not there.
TriangleMesh load_dataset(const std::string& id, int vertices);

}  // namespace softform
