#pragma once

#include <optional>
#include <string>

#include <CLI/CLI.hpp>

namespace softform::cli {

/// A positive length with a unit, in metres. Throws InputError naming the option.
CLI::Option* add_length(CLI::App& command, const std::string& name, std::optional<double>& metres,
                        const std::string& help);

/// A positive pressure with a unit, in pascals. Throws InputError naming the option.
CLI::Option* add_pressure(CLI::App& command, const std::string& name, std::optional<double>& pascals,
                          const std::string& help);

/// A finite number above `lower`. Throws InputError naming the option.
CLI::Option* add_number(CLI::App& command, const std::string& name, std::optional<double>& number, double lower,
                        const std::string& help);

/// What inflate and balloon ask for alike.
struct BalloonInput {
  std::string mesh;
  std::string material;
  std::optional<double> thickness;  ///< [m]
  std::optional<double> size;       ///< [m]
  std::string out;
};

/// Adds the options of a BalloonInput; `mesh_name` is the positional one's name in the help.
void add_balloon_input(CLI::App& command, BalloonInput& input, const std::string& mesh_name);

}  // namespace softform::cli
