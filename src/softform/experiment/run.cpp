#include "softform/experiment/run.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <fstream>

#include <fmt/format.h>

#include "softform/core/error.hpp"
#include "softform/core/interrupt.hpp"
#include "softform/experiment/provenance.hpp"
#include "softform/io/text_file.hpp"

namespace softform {
namespace {

bool on_terminal() { return isatty(STDERR_FILENO) != 0; }

}  // namespace

Run::Run(std::string id, RunOptions options) : id_(std::move(id)), options_(std::move(options)), started_(utc_now())
{
  std::error_code error;
  std::filesystem::create_directories(options_.out, error);
  write_text(path("run.log"), "");
}

Run::~Run()
{
  if (on_terminal()) std::fputs("\r\033[K", stderr);
}

double Run::elapsed_s() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

void Run::show(const std::string& line) const
{
  const auto text = fmt::format("{:8.2f} s  {}  {}", elapsed_s(), id_, line);
  fmt::print(stderr, "{}", on_terminal() ? "\r\033[K" + text.substr(0, 118) : text + "\n");
  std::fflush(stderr);
}

void Run::step(const std::string& text)
{
  if (interrupted()) throw InterruptedRun("stopped before: " + text);
  current_step_ = text;
  show(text);
  log(text);
}

void Run::progress(const std::string& remark)
{
  if (on_terminal()) show(current_step_ + ": " + remark);
  log("  " + remark);
}

void Run::log(const std::string& line)
{
  std::ofstream(path("run.log"), std::ios::app) << fmt::format("{:10.3f} s  {}\n", elapsed_s(), line);
}

IterationObserver Run::observer()
{
  return [this](const Iterate& it) {
    progress(fmt::format("iteration {}, objective {:.6g}, stationarity {:.2e}", it.k, it.objective, it.stationarity));
    return !interrupted();
  };
}

void Run::metric(const std::string& name, double value, const std::string& unit)
{
  if (std::any_of(metrics_.begin(), metrics_.end(), [&](const Metric& known) { return known.name == name; }))
    throw std::logic_error(fmt::format("metric {} is recorded twice", name));
  metrics_.push_back({name, value, unit});
  log(fmt::format("metric {} = {} {}", name, value, unit));
}

CsvTable& Run::series(const std::string& name, const std::vector<Column>& columns)
{
  return series_.try_emplace(name, columns).first->second;
}

void Run::trace(const std::string& name, const std::vector<Iterate>& iterates)
{
  CsvTable& table = series(name, {{"iteration"},
                                  {"objective"},
                                  {"stationarity"},
                                  {"infeasibility"},
                                  {"step_norm"},
                                  {"elapsed", "s"},
                                  {"linear_solves"}});
  for (const Iterate& it : iterates)
    table.add_row({double(it.k), it.objective, it.stationarity, it.infeasibility, it.step_norm, it.elapsed_s,
                   double(it.linear_solves)});
}

double Run::time(const std::string& name, const std::function<void()>& body)
{
  const auto start = Clock::now();
  body();
  const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
  metric("time_" + name, seconds, "s");
  return seconds;
}

double Run::cpu_s()
{
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

void Run::write(const std::string& outcome) const
{
  // Before any file changes: results are committed, and would make the source tree look dirty.
  const Provenance provenance{.experiment = id_,
                              .outcome = outcome,
                              .size = is_paper() ? "paper" : "quick",
                              .seed = seed(),
                              .threads = threads(),
                              .started = started_,
                              .finished = utc_now(),
                              .datasets = datasets_};
  const std::string provenance_text = provenance_json(provenance);
  auto metrics = metrics_;
  metrics.push_back({"time", elapsed_s(), "s"});
  write_text(path("metrics.csv"), metrics_csv(metrics));
  for (const auto& [name, table] : series_) write_text(path(name + ".csv"), table.text());
  write_text(path("provenance.json"), provenance_text);
}

}  // namespace softform
