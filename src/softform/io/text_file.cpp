#include "softform/io/text_file.hpp"

#include <fstream>
#include <iterator>

#include <fmt/format.h>

#include "softform/core/error.hpp"
#include "softform/io/atomic_write.hpp"

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
  write_atomically(file, [&](const fs::path& temporary) {
    std::ofstream stream(temporary, std::ios::binary);
    stream << text;
    stream.close();
    return !stream.fail();
  });
}

}  // namespace softform
