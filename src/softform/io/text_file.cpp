#include "softform/io/text_file.hpp"

#include <fstream>
#include <iterator>

#include <fmt/format.h>

#include "softform/core/error.hpp"

namespace softform {

namespace fs = std::filesystem;

std::string read_text(const fs::path& file)
{
  std::ifstream stream(file, std::ios::binary);
  if (!stream || fs::is_directory(file))
    throw InputError(fmt::format("{}: cannot be read; check the name and the permissions", file.string()));
  return {std::istreambuf_iterator<char>(stream), {}};
}

void write_text(const fs::path& file, const std::string& text)
{
  std::error_code error;
  if (file.has_parent_path()) fs::create_directories(file.parent_path(), error);
  const fs::path temporary = file.string() + ".part";
  {
    std::ofstream stream(temporary, std::ios::binary);
    stream << text;
    stream.close();
    if (!stream)
      throw InputError(fmt::format("{}: cannot be written; check the folder's permissions and space", file.string()));
  }
  fs::rename(temporary, file, error);
  if (error) throw InputError(fmt::format("{}: cannot be replaced: {}", file.string(), error.message()));
}

}  // namespace softform
