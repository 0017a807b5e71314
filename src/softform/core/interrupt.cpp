#include "softform/core/interrupt.hpp"

#include <atomic>
#include <csignal>

namespace softform {
namespace {

std::atomic<bool> interrupt_flag{false};

extern "C" void on_interrupt(int signal_number)
{
  interrupt_flag = true;
  std::signal(signal_number, SIG_DFL);
}

}  // namespace

void catch_interrupts()
{
  std::signal(SIGINT, on_interrupt);
  std::signal(SIGTERM, on_interrupt);
}

bool interrupted() { return interrupt_flag; }

}  // namespace softform
