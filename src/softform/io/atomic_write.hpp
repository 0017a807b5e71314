#pragma once

#include <filesystem>
#include <functional>

namespace softform {

/// Lets `write` fill a temporary file beside `path` (same extension) and renames it to `path` when it returns true, so
/// that no half-written file is ever seen under the name. Creates the folder. Throws InputError naming the path when
/// the folder or file cannot be written.
void write_atomically(const std::filesystem::path& path,
                      const std::function<bool(const std::filesystem::path&)>& write);

}  // namespace softform
