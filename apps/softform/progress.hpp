#pragma once

#include <chrono>
#include <string>

namespace softform::cli {

/// Tells the user how far a long computation is, on stderr: one line that is updated on a terminal, from the third
/// second on; one line a step elsewhere.
class Progress {
 public:
  Progress();
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// The same text twice is shown once.
  void step(const std::string& text);

  /// Clears the line, before messages that are to stay.
  void end();

  /// Since construction.
  double elapsed_s() const;

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  bool is_terminal_;
  bool is_line_shown_ = false;
  std::string last_;
};

}  // namespace softform::cli
