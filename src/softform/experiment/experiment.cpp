#include "softform/experiment/experiment.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "build_info.hpp"
#include "softform/core/error.hpp"
#include "softform/core/interrupt.hpp"
#include "softform/core/parallel.hpp"

extern "C" void openblas_set_num_threads(int count);

namespace softform {
namespace {

void print_info(const ExperimentInfo& info)
{
  const nlohmann::ordered_json json{{"id", info.id},
                                    {"section", info.section},
                                    {"claim", info.claim},
                                    {"minutes", {{"quick", info.minutes.quick}, {"paper", info.minutes.paper}}}};
  fmt::print("{}\n", json.dump());
}

/// Runs the body and tells how it ended: what Run::write notes as outcome, and the exit code.
std::pair<std::string, int> outcome_of(const std::function<void(Run&)>& body, Run& run)
{
  try {
    body(run);
    if (interrupted()) return {"interrupted", 130};
    return {"completed", 0};
  } catch (const InterruptedRun& stop) {
    return {fmt::format("interrupted: {}", stop.what()), 130};
  } catch (const InputError& error) {
    return {fmt::format("bad input: {}", error.what()), 2};
  } catch (const std::exception& error) {
    return {fmt::format("failed: {}", error.what()), 1};
  }
}

int execute(const ExperimentInfo& info, const RunOptions& options, const std::function<void(Run&)>& body)
{
  set_thread_count(options.threads);
  openblas_set_num_threads(options.threads);
  catch_interrupts();
  try {
    Run run(info.id, options);
    const auto [outcome, code] = outcome_of(body, run);
    run.write(outcome);
    run.log(outcome);
    if (code != 0) fmt::print(stderr, "\n{}: {}\nWhat was computed is in {}\n", info.id, outcome, options.out.string());
    return code;
  } catch (const InputError& error) {
    fmt::print(stderr, "{}: {}\n", info.id, error.what());
    return 2;
  }
}

}  // namespace

int run_experiment(int argc, char** argv, const ExperimentInfo& info, const std::function<void(Run&)>& body)
{
  RunOptions options;
  options.threads = thread_count();
  bool list = false;
  const std::map<std::string, Size> sizes{{"quick", Size::Quick}, {"paper", Size::Paper}};

  CLI::App app(fmt::format("{} (thesis section {}): {}", info.id, info.section, info.claim), info.id);
  app.add_option("--size", options.size, "quick (coarse mesh, seconds) or paper (the thesis' sizes)")
      ->transform(CLI::CheckedTransformer(sizes))
      ->option_text("quick|paper");
  app.add_option("--out", options.out, "folder of the results [results/quick/ID or results/ID]");
  app.add_option("--threads", options.threads, "threads of assembly and BLAS [all cores]")->check(CLI::Range(1, 1024));
  app.add_option("--seed", options.seed, "seed of everything random")->capture_default_str();
  app.add_flag("--list", list, "print id, section, claim and minutes as JSON and do nothing else");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  if (list) {
    print_info(info);
    return 0;
  }
  if (options.out.empty()) {
    const auto results = std::filesystem::path(build_info::source_dir) / "results";
    options.out = (options.size == Size::Paper ? results : results / "quick") / info.id;
  }
  return execute(info, options, body);
}

}  // namespace softform
