#include "nozzle_options.hpp"

#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdlib>

#include <fmt/format.h>

#include "options.hpp"
#include "softform/core/error.hpp"

namespace softform::cli {
namespace {

std::optional<int> whole_number(const std::string& text)
{
  int number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

}  // namespace

CLI::Option* add_nozzle(CLI::App& command, NozzleInput& input)
{
  add_length(command, "--nozzle-diameter", input.diameter, "Diameter of the nozzle [12mm]");
  return command
      .add_option("--nozzle", input.place,
                  "Where the balloon is blown up: bottom (-z), a direction such as -y or\n0.1,0,-1 from the middle, or "
                  "the number of a vertex, counted from 0")
      ->type_name("bottom|DIRECTION|VERTEX");
}

Vec3 parse_direction(const std::string& option, const std::string& text)
{
  const std::string axes = "xyz";
  const std::string letter = text.empty() || (text[0] != '-' && text[0] != '+') ? text : text.substr(1);
  if (letter.size() == 1 && axes.find(letter) != std::string::npos)
    return (text[0] == '-' ? -1 : 1) * Vec3::Unit(static_cast<Eigen::Index>(axes.find(letter)));
  Vec3 direction;
  const char* position = text.c_str();
  for (Eigen::Index k = 0; k < 3; ++k) {
    char* end = nullptr;
    direction[k] = std::strtod(position, &end);
    if (end == position || *end != (k < 2 ? ',' : '\0'))
      throw InputError(fmt::format("{}: '{}' is no direction: give one such as -y or 0.1,0,-1", option, text));
    position = end + 1;
  }
  if (!direction.allFinite() || !(direction.norm() > 0))
    throw InputError(fmt::format("{}: the direction {} has no length: give one such as -y", option, text));
  return direction;
}

std::optional<NozzlePlacement> nozzle_placement(const NozzleInput& input)
{
  if (input.place.empty()) {
    if (input.diameter) throw InputError("--nozzle-diameter: say where with --nozzle, for example --nozzle bottom");
    return std::nullopt;
  }
  NozzlePlacement placement;
  if (const auto vertex = whole_number(input.place))
    placement.vertex = *vertex;
  else if (input.place != "bottom")
    placement.direction = parse_direction("--nozzle", input.place);
  placement.diameter = input.diameter.value_or(placement.diameter);
  return placement;
}

}  // namespace softform::cli
