#include "options.hpp"

#include <cmath>
#include <cstdlib>

#include <fmt/format.h>

#include "softform/core/error.hpp"
#include "softform/core/units.hpp"

namespace softform::cli {
namespace {

CLI::Option* add_quantity(CLI::App& command, const std::string& name, std::optional<double>& value,
                          double (*parse)(const std::string&), double lower, const std::string& help)
{
  const auto store = [&value, name, parse, lower](const std::string& text) {
    try {
      value = parse(text);
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}: {}", name, error.what()));
    }
    if (!(*value > lower))
      throw InputError(fmt::format("{}: {} is too small: it must be above {:g}", name, text, lower));
  };
  return command.add_option_function<std::string>(name, store, help);
}

double parse_number(const std::string& text)
{
  char* end = nullptr;
  const double number = std::strtod(text.c_str(), &end);
  if (end == text.c_str() || *end != '\0' || !std::isfinite(number))
    throw InputError(fmt::format("'{}' is not a plain number", text));
  return number;
}

}  // namespace

CLI::Option* add_length(CLI::App& command, const std::string& name, std::optional<double>& metres,
                        const std::string& help)
{
  return add_quantity(command, name, metres, parse_length, 0, help)->type_name("LENGTH");
}

CLI::Option* add_pressure(CLI::App& command, const std::string& name, std::optional<double>& pascals,
                          const std::string& help)
{
  return add_quantity(command, name, pascals, parse_pressure, 0, help)->type_name("PRESSURE");
}

CLI::Option* add_number(CLI::App& command, const std::string& name, std::optional<double>& number, double lower,
                        const std::string& help)
{
  return add_quantity(command, name, number, parse_number, lower, help)->type_name("NUMBER");
}

void add_balloon_input(CLI::App& command, BalloonInput& input, const std::string& mesh_name)
{
  command.add_option(mesh_name, input.mesh, "Closed surface: OBJ, OFF, PLY or STL")->required();
  command.add_option("--material", input.material, "Material: a JSON file, or a name such as silicone or latex")
      ->required()
      ->type_name("FILE|NAME");
  add_length(command, "--thickness", input.thickness, "Thickness of the rubber at rest, for example 0.3mm")->required();
  add_length(
      command, "--size", input.size,
      "Largest distance between two vertices, for example 146mm;\nwithout it the file's numbers are millimetres");
  command.add_option("--out", input.out, "Folder for the results; created if need be")->required()->type_name("DIR");
}

}  // namespace softform::cli
