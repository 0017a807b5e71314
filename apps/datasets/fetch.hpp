#pragma once

#include <filesystem>

#include "softform/io/datasets.hpp"

namespace softform {

/// The third party's file of a dataset, its SHA-256 checked. Taken from `from` when that is given (another SHA-256 is
/// then only a warning), else from <cache>/raw, else out of the Debian package, which apt downloads without
/// installing it. Throws InputError that names the cure.
std::filesystem::path raw_file(const Dataset& dataset, const std::filesystem::path& cache,
                               const std::filesystem::path& from);

}  // namespace softform
