#include "softform/experiment/provenance.hpp"

#include <array>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <memory>

#include <Eigen/Core>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "build_info.hpp"

extern "C" char* openblas_get_config();

namespace softform {
namespace {

/// What a shell command prints, without line ends; empty when it fails.
std::string output_of(const std::string& command)
{
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  std::string text;
  std::array<char, 128> line{};
  while (pipe && std::fgets(line.data(), line.size(), pipe.get())) text += line.data();
  std::erase(text, '\n');
  return text;
}

/// The commit that the source tree stands at, with "-dirty" when its sources have changes; "unknown" outside a
/// checkout. What runs write does not count: this one is about to.
std::string git_commit()
{
  const std::string git = fmt::format("git -C '{}'", build_info::source_dir);
  const std::string commit = output_of(git + " rev-parse HEAD 2>/dev/null");
  if (commit.empty()) return "unknown";
  const std::string sources = "-- . ':!results' ':!figures' ':!paper_repro.md'";
  return commit + (output_of(fmt::format("{} status --porcelain -uno {}", git, sources)).empty() ? "" : "-dirty");
}

std::string cpu_model()
{
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);)
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  return "unknown";
}

}  // namespace

std::string utc_now() { return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr))); }

std::string provenance_json(const Provenance& run)
{
  const nlohmann::ordered_json json{
      {"experiment", run.experiment},
      {"outcome", run.outcome},
      {"size", run.size},
      {"seed", run.seed},
      {"commit", git_commit()},
      {"compiler", build_info::compiler},
      {"flags", build_info::flags},
      {"build_type", build_info::build_type},
      {"eigen", fmt::format("{}.{}.{}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION)},
      {"blas", openblas_get_config()},
      {"cpu", cpu_model()},
      {"threads", run.threads},
      {"started", run.started},
      {"finished", run.finished},
      {"datasets", run.datasets}};
  return json.dump(2) + "\n";
}

}  // namespace softform
