#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "softform/core/report.hpp"
#include "softform/io/csv.hpp"

namespace softform {

/// How large an experiment runs: seconds to a minute on a coarse mesh, or the thesis' sizes.
enum class Size { Quick, Paper };

/// Thrown by Run::step after Ctrl-C, so that an experiment ends between two steps with what it has.
class InterruptedRun : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What the command line chose.
struct RunOptions {
  Size size = Size::Quick;
  std::filesystem::path out;  ///< the folder of the results
  int threads = 1;
  unsigned seed = 1;
};

/// An experiment's only door to disk, clock, seed, size and command line.
///
/// Metrics and series are kept and written together by `write`, each file under a temporary name and then renamed.
class Run {
 public:
  Run(std::string id, RunOptions options);
  ~Run();
  Run(const Run&) = delete;
  Run& operator=(const Run&) = delete;

  bool is_paper() const { return options_.size == Size::Paper; }
  /// The value for the size that runs: `run.by_size(600, 4975)`.
  template <class T>
  T by_size(T quick, T paper) const
  {
    return is_paper() ? paper : quick;
  }
  unsigned seed() const { return options_.seed; }
  int threads() const { return options_.threads; }

  /// A file of the results folder, for example run.path("rest.vtp"). The folder exists.
  std::filesystem::path path(const std::string& file) const { return options_.out / file; }

  /// Announces the next step on stderr (one updating line on a terminal) and in run.log.
  /// Throws InterruptedRun after Ctrl-C.
  void step(const std::string& text);
  /// The same line with a remark about the current step; a terminal shows it, run.log keeps it.
  void progress(const std::string& remark);
  /// A line in run.log alone.
  void log(const std::string& line);
  /// Shows a solver's iterations as progress and stops it after Ctrl-C.
  IterationObserver observer();

  /// A named result; a name may come once. Throws std::logic_error on a second one.
  void metric(const std::string& name, double value, const std::string& unit);
  /// A table written as <name>.csv; the same name returns the same table.
  CsvTable& series(const std::string& name, const std::vector<Column>& columns);
  /// A solver's iterates as the table <name>.csv.
  void trace(const std::string& name, const std::vector<Iterate>& iterates);
  /// Runs `body`, records its seconds as the metric time_<name> and returns them.
  double time(const std::string& name, const std::function<void()>& body);
  /// CPU seconds of this process so far, of all its threads: what methods are compared by, for it does not count what
  /// else the machine does.
  static double cpu_s();
  /// Notes in the provenance which input was used.
  void dataset(const std::string& id, const std::string& sha256) { datasets_[id] = sha256; }

  /// metrics.csv, the series and provenance.json; `outcome` is "completed", "interrupted" or an error's message.
  void write(const std::string& outcome) const;

 private:
  using Clock = std::chrono::steady_clock;
  double elapsed_s() const;
  void show(const std::string& line) const;

  std::string id_;
  RunOptions options_;
  Clock::time_point start_ = Clock::now();
  std::string started_;
  std::string current_step_;
  std::vector<Metric> metrics_;
  std::map<std::string, CsvTable> series_;
  std::map<std::string, std::string> datasets_;
};

}  // namespace softform
