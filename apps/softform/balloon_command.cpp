#include "commands.hpp"
namespace softform::cli {
void add_balloon_command(CLI::App&, ExitCode&) {}
}  // namespace softform::cli
