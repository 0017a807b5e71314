// softform-datasets: prepares the meshes of the experiments from third parties' files, implicit models and exact
// shapes.

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include "prepare.hpp"
#include "softform/core/error.hpp"
#include "softform/io/datasets.hpp"

using namespace softform;

namespace {

/// The datasets of those ids, all without ids. Throws InputError for an unknown one.
std::vector<Dataset> selected(const std::vector<Dataset>& all, const std::vector<std::string>& ids)
{
  if (ids.empty()) return all;
  std::vector<Dataset> chosen;
  for (const std::string& id : ids) {
    const auto found = std::find_if(all.begin(), all.end(), [&](const Dataset& dataset) { return dataset.id == id; });
    if (found == all.end())
      throw InputError(fmt::format("there is no dataset '{}'; `softform-datasets list` names them", id));
    chosen.push_back(*found);
  }
  return chosen;
}

std::string origin(const Dataset& dataset)
{
  if (dataset.origin) return dataset.origin->member + " of Debian's " + dataset.origin->package;
  if (dataset.model) return "procedural: implicit model of our own, " + dataset.model->filename().string();
  return "procedural: exact shape of our own";
}

void list(const std::vector<Dataset>& datasets, const std::filesystem::path& cache)
{
  for (const Dataset& dataset : datasets) {
    std::vector<std::string> sizes;
    for (const int vertices : dataset.vertices)
      sizes.push_back(fmt::format(
          "{}{}", vertices, std::filesystem::exists(dataset_file(cache, dataset.id, vertices)) ? " (prepared)" : ""));
    fmt::print(
        "{:<11} vertices {}\n            {}\n            unit: {}\n            credit: {}\n            licence: {}\n",
        dataset.id, fmt::join(sizes, ", "), origin(dataset), dataset.unit, dataset.credit, dataset.licence);
  }
}

/// How many prepared meshes are not as they should be.
int check(const std::vector<Dataset>& datasets, const std::filesystem::path& cache)
{
  int bad = 0;
  for (const Dataset& dataset : datasets) {
    for (const int vertices : dataset.vertices) {
      const std::string reason = shortcoming(dataset, vertices, cache);
      fmt::print("{}: {}\n", dataset_file(cache, dataset.id, vertices).string(), reason.empty() ? "good" : reason);
      bad += reason.empty() ? 0 : 1;
    }
  }
  return bad;
}

}  // namespace

int main(int argc, char** argv)
{
  spdlog::set_default_logger(spdlog::stderr_color_st("softform-datasets"));
  spdlog::set_pattern("%n: %^%l%$: %v");

  CLI::App app("Prepares the meshes of softform's experiments: exact vertex counts, watertight, well-shaped triangles");
  app.require_subcommand(1);
  app.fallthrough();
  std::vector<std::string> ids;
  PreparePaths paths{dataset_cache(), {}};
  std::filesystem::path manifest = default_manifest();
  app.add_option("--cache", paths.cache, "folder of the prepared meshes")->capture_default_str();
  app.add_option("--manifest", manifest, "what there is")->capture_default_str();

  CLI::App* prepare_command = app.add_subcommand("prepare", "prepare datasets (all of them without an id)");
  prepare_command->add_option("id", ids, "datasets");
  prepare_command->add_option("--from", paths.from, "take third parties' meshes from this folder")
      ->check(CLI::ExistingDirectory);
  CLI::App* list_command = app.add_subcommand("list", "origin, credit and licence of each");
  list_command->add_option("id", ids, "datasets");
  CLI::App* check_command = app.add_subcommand("check", "examine what is prepared");
  check_command->add_option("id", ids, "datasets");

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  try {
    const std::vector<Dataset> datasets = selected(read_manifest(manifest), ids);
    if (list_command->parsed()) list(datasets, paths.cache);
    if (check_command->parsed()) return check(datasets, paths.cache) == 0 ? 0 : 2;
    if (prepare_command->parsed())
      for (const Dataset& dataset : datasets) prepare(dataset, paths);
    return 0;
  } catch (const InputError& error) {
    spdlog::error("{}", error.what());
    return 2;
  } catch (const std::exception& error) {
    spdlog::error("{}", error.what());
    return 1;
  }
}
