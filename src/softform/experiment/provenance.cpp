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

/// The commit that the source tree stands at, with "-dirty" when it has changes; "unknown" outside a checkout.
std::string git_commit()
{
  const auto command = fmt::format("git -C '{}' describe --always --abbrev=40 --exclude '*' --dirty 2>/dev/null",
                                   build_info::source_dir);
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  std::array<char, 128> line{};
  if (!pipe || !std::fgets(line.data(), line.size(), pipe.get())) return "unknown";
  std::string commit(line.data());
  return commit.substr(0, commit.find('\n'));
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
