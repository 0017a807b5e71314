#pragma once

#include <CLI/CLI.hpp>

namespace softform::cli {

/// What the shell is told. Anything else that goes wrong is a fault of ours and gives 1.
enum ExitCode : int {
  Success = 0,
  BadInput = 2,      ///< nothing was computed and nothing written
  NotReached = 3,    ///< no equilibrium there; what was computed is written
  Interrupted = 130  ///< Ctrl-C; what was computed is written
};

/// Each adds its subcommand to the program; when that is the one called, its outcome is put into `exit_code`.
void add_character_command(CLI::App& program, ExitCode& exit_code);
void add_check_command(CLI::App& program, ExitCode& exit_code);
void add_inflate_command(CLI::App& program, ExitCode& exit_code);
void add_balloon_command(CLI::App& program, ExitCode& exit_code);
void add_mould_command(CLI::App& program, ExitCode& exit_code);
void add_panels_command(CLI::App& program, ExitCode& exit_code);
void add_fit_command(CLI::App& program, ExitCode& exit_code);
void add_model_command(CLI::App& program, ExitCode& exit_code);
void add_inflatable_command(CLI::App& program, ExitCode& exit_code);
void add_pillow_command(CLI::App& program, ExitCode& exit_code);

}  // namespace softform::cli
