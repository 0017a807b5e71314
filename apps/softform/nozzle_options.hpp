#pragma once

#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include "softform/balloons/nozzle.hpp"

namespace softform::cli {

struct NozzleInput {
  std::string place;               ///< bottom, a direction or a vertex; empty: no nozzle
  std::optional<double> diameter;  ///< [m]
};

/// --nozzle and --nozzle-diameter.
CLI::Option* add_nozzle(CLI::App& command, NozzleInput& input);

/// What they say. Throws InputError naming the option.
std::optional<NozzlePlacement> nozzle_placement(const NozzleInput& input);

/// "-y", "+z" or "0.1,0,-1". Throws InputError naming the option.
Vec3 parse_direction(const std::string& option, const std::string& text);

}  // namespace softform::cli
