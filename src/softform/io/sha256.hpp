#pragma once

#include <filesystem>
#include <string>

namespace softform {

/// The SHA-256 of a file in 64 hexadecimal digits. Throws InputError when it cannot be read.
std::string sha256_of_file(const std::filesystem::path& path);

}  // namespace softform
