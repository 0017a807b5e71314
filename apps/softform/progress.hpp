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

  void step(const std::string& text);

  /// Since construction.
  double elapsed_s() const;

 private:
  void clear_line();

  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  bool is_terminal_;
  bool is_line_shown_ = false;
};

}  // namespace softform::cli
