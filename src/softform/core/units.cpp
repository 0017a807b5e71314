#include "softform/core/units.hpp"

#include <cmath>
#include <cstdlib>
#include <map>

#include <fmt/format.h>

#include "softform/core/error.hpp"

namespace softform {
namespace {

using UnitTable = std::map<std::string, double>;

const UnitTable length_units{{"um", 1e-6}, {"mm", 1e-3}, {"cm", 1e-2}, {"m", 1.0}, {"in", 0.0254}};
const UnitTable pressure_units{{"Pa", 1.0},  {"hPa", 1e2},      {"kPa", 1e3},      {"MPa", 1e6}, {"mbar", 1e2},
                               {"bar", 1e5}, {"mmHg", 133.322}, {"psi", 6894.757}, {"GPa", 1e9}};
const UnitTable density_units{{"kg/m^3", 1.0}, {"g/cm^3", 1e3}};
const UnitTable acceleration_units{{"m/s^2", 1.0}};

std::string unit_names(const UnitTable& table)
{
  std::string names;
  for (const auto& [name, factor] : table) names += (names.empty() ? "" : ", ") + name;
  return names;
}

double parse_quantity(const std::string& text, const UnitTable& table, const char* what, const char* example)
{
  char* end = nullptr;
  const double number = std::strtod(text.c_str(), &end);
  const std::string rest(end);
  if (end == text.c_str() || !std::isfinite(number))
    throw InputError(fmt::format("'{}' is not a {}: write a number and a unit, for example {}", text, what, example));
  const auto first = rest.find_first_not_of(" \t");
  if (first == std::string::npos)
    throw InputError(fmt::format("'{}' has no unit: write for example {}", text, example));
  const std::string unit = rest.substr(first, rest.find_last_not_of(" \t") - first + 1);
  const auto entry = table.find(unit);
  if (entry == table.end())
    throw InputError(fmt::format("'{}' has the unit '{}', which is no unit of {}: use one of {}", text, unit, what,
                                 unit_names(table)));
  return number * entry->second;
}

}  // namespace

double parse_length(const std::string& text) { return parse_quantity(text, length_units, "length", "0.3mm"); }

double parse_pressure(const std::string& text) { return parse_quantity(text, pressure_units, "pressure", "1kPa"); }

double parse_density(const std::string& text) { return parse_quantity(text, density_units, "density", "1070kg/m^3"); }

double parse_acceleration(const std::string& text)
{
  return parse_quantity(text, acceleration_units, "acceleration", "9.81m/s^2");
}

}  // namespace softform
