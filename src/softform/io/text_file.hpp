#pragma once

#include <filesystem>
#include <string>

namespace softform {

/// The whole file. Throws InputError naming the file when it cannot be read.
std::string read_text(const std::filesystem::path& file);

/// Writes beside the file under a temporary name, then renames: readers see the old text or the new, never half.
/// Creates missing folders. Throws InputError naming the file when it cannot be written.
void write_text(const std::filesystem::path& file, const std::string& text);

}  // namespace softform
