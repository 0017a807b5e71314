#include "progress.hpp"

#include <unistd.h>

#include <cstdio>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

namespace softform::cli {

Progress::Progress() : is_terminal_(isatty(STDERR_FILENO) != 0) {}

Progress::~Progress() { end(); }

double Progress::elapsed_s() const
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

void Progress::step(const std::string& text)
{
  if (!is_terminal_) {
    if (text == last_) return;
    last_ = text;
    spdlog::info("{:.1f} s: {}", elapsed_s(), text);
    return;
  }
  if (elapsed_s() < 2) return;
  end();
  fmt::print(stderr, "{:.0f} s: {}", elapsed_s(), text);
  std::fflush(stderr);
  is_line_shown_ = true;
}

void Progress::end()
{
  if (is_line_shown_) fmt::print(stderr, "\r\033[K");
  is_line_shown_ = false;
}

}  // namespace softform::cli
