#pragma once

#include <filesystem>
#include <string>

#include "softform/io/datasets.hpp"

namespace softform {

/// Where things are.
struct PreparePaths {
  std::filesystem::path cache;
  std::filesystem::path from;  ///< a folder of the user's own meshes, or empty
};

/// Writes <cache>/<id>_<vertices>.off for every size of the dataset that is not there yet, with a stamp beside it that
/// says from which input. Throws InputError.
void prepare(const Dataset& dataset, const PreparePaths& paths);

/// What is wrong with a prepared mesh, or nothing: exactly the vertices asked for, watertight, genus 0, no
/// self-intersection, smallest angle above 20 degrees, unchanged since it was prepared.
std::string shortcoming(const Dataset& dataset, int vertices, const std::filesystem::path& cache);

}  // namespace softform
