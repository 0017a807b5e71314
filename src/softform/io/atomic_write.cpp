#include "softform/io/atomic_write.hpp"

#include <unistd.h>

#include <fmt/format.h>

#include "softform/core/error.hpp"

namespace softform {

void write_atomically(const std::filesystem::path& path, const std::function<bool(const std::filesystem::path&)>& write)
{
  const std::filesystem::path folder = path.parent_path().empty() ? "." : path.parent_path();
  // The process id keeps two programs that write the same file apart.
  const auto name = fmt::format(".{}.{}.partial{}", path.stem().string(), ::getpid(), path.extension().string());
  const std::filesystem::path temporary = folder / name;

  std::error_code error;
  std::filesystem::create_directories(folder, error);
  const bool written = !error && write(temporary);
  if (written) std::filesystem::rename(temporary, path, error);
  if (!written || error) {
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
    throw InputError(fmt::format("{}: cannot be written{}; check that the folder is writable and the disk not full",
                                 path.string(), error ? " (" + error.message() + ")" : ""));
  }
}

}  // namespace softform
