#include "softform/fitting/rubber_test.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <optional>
#include <set>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "softform/core/error.hpp"
#include "softform/core/units.hpp"
#include "softform/fitting/homogeneous.hpp"
#include "softform/io/text_file.hpp"

namespace softform {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t fewest_points = 3;
constexpr double largest_plausible_stretch = 15;   // no rubber goes further; 120 would be a percentage
constexpr double largest_plausible_stress = 1e9;   // [Pa]
constexpr double smallest_plausible_stress = 100;  // [Pa], of the largest in a test
constexpr double largest_stress_at_rest = 0.05;    // of the largest in a test: a small offset of the load cell

std::string trimmed(const std::string& text)
{
  const auto first = text.find_first_not_of(" \t\r"), last = text.find_last_not_of(" \t\r");
  return first == std::string::npos ? "" : text.substr(first, last - first + 1);
}

std::vector<std::string> split(const std::string& line)
{
  std::vector<std::string> fields;
  std::istringstream stream(line);
  for (std::string field; std::getline(stream, field, ',');) fields.push_back(trimmed(field));
  if (!line.empty() && line.back() == ',') fields.emplace_back();
  return fields;
}

/// The text of a file taken apart: `# key: value` lines, the columns' names, rows of numbers with their lines.
struct Table {
  struct Row {
    int line;
    std::vector<double> values;
  };
  std::map<std::string, std::string> keys;
  std::vector<std::string> columns;
  int header_line = 0;
  std::vector<Row> rows;
};

double parse_number(const std::string& text, int line)
{
  char* end = nullptr;
  const double number = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0')
    throw InputError(fmt::format("line {}: '{}' is not a number: correct it", line, text));
  if (!std::isfinite(number))
    throw InputError(fmt::format("line {}: {} is not a finite number: correct it or remove the row", line, text));
  return number;
}

std::string without_byte_order_mark(const std::string& text)
{
  return text.substr(text.rfind("\xEF\xBB\xBF", 0) == 0 ? 3 : 0);
}

void refuse_twice(const std::vector<std::string>& columns, int line)
{
  std::set<std::string> seen;
  for (const std::string& name : columns)
    if (!seen.insert(name).second)
      throw InputError(fmt::format("line {}: the column '{}' comes twice: keep one", line, name));
}

Table parse_table(const std::string& text)
{
  Table table;
  std::istringstream stream(without_byte_order_mark(text));
  int line = 0;
  for (std::string content; std::getline(stream, content);) {
    ++line;
    content = trimmed(content);
    if (content.empty()) continue;
    if (content[0] == '#') {
      if (const auto colon = content.find(':'); colon != std::string::npos)
        table.keys[trimmed(content.substr(1, colon - 1))] = trimmed(content.substr(colon + 1));
    } else if (table.columns.empty()) {
      table.columns = split(content);
      table.header_line = line;
      refuse_twice(table.columns, line);
    } else {
      const auto fields = split(content);
      if (fields.size() != table.columns.size())
        throw InputError(fmt::format("line {}: {} values where the header has {} columns: correct it", line,
                                     fields.size(), table.columns.size()));
      Table::Row row{line, {}};
      for (const std::string& field : fields) row.values.push_back(parse_number(field, line));
      table.rows.push_back(std::move(row));
    }
  }
  if (table.columns.empty())
    throw InputError("is empty: it needs a line of column names such as stretch,nominal_stress_mpa and rows below it");
  return table;
}

using Units = std::map<std::string, double>;
const Units stress_units{{"pa", 1}, {"kpa", 1e3}, {"mpa", 1e6}, {"kgf_cm2", 98066.5}};
const Units length_units{{"mm", 1e-3}, {"cm", 1e-2}, {"m", 1}};

/// A column by its name without the unit, and the factor that makes it SI.
struct FoundColumn {
  std::size_t index;
  double factor;
  std::string unit;
};

std::string names_with(const std::string& stem, const Units& units)
{
  std::vector<std::string> names;
  for (const auto& [unit, factor] : units) names.push_back(stem + "_" + unit);
  return fmt::format("{}", fmt::join(names, ", "));
}

/// Takes the one column `stem`_UNIT out of `left`; nothing where there is none.
std::optional<FoundColumn> find_quantity(const Table& table, const std::string& stem, const Units& units,
                                         std::set<std::string>& left)
{
  std::optional<FoundColumn> found;
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    const std::string& name = table.columns[i];
    if (name.rfind(stem + "_", 0) != 0) continue;
    const auto unit = units.find(name.substr(stem.size() + 1));
    if (unit == units.end()) continue;
    if (found)
      throw InputError(fmt::format("line {}: the columns '{}' and '{}' give the same quantity twice: keep one",
                                   table.header_line, table.columns[found->index], name));
    found = FoundColumn{i, unit->second, unit->first};
    left.erase(name);
  }
  return found;
}

std::size_t require_plain(const Table& table, const std::string& name, std::set<std::string>& left)
{
  const auto column = std::find(table.columns.begin(), table.columns.end(), name);
  if (column == table.columns.end())
    throw InputError(fmt::format("line {}: the column '{}' is missing among '{}': add it", table.header_line, name,
                                 fmt::join(table.columns, ",")));
  left.erase(name);
  return std::size_t(column - table.columns.begin());
}

FoundColumn require_quantity(const Table& table, const std::string& stem, const Units& units,
                             std::set<std::string>& left)
{
  const auto found = find_quantity(table, stem, units, left);
  if (!found)
    throw InputError(fmt::format("line {}: no column for the {} among '{}': name it one of {}", table.header_line, stem,
                                 fmt::join(table.columns, ","), names_with(stem, units)));
  return *found;
}

/// A stress column, nominal or true.
struct StressColumn : FoundColumn {
  bool is_true = false;
};

StressColumn require_stress(const Table& table, const std::string& suffix, std::set<std::string>& left)
{
  const auto nominal = find_quantity(table, "nominal_stress" + suffix, stress_units, left);
  const auto truth = find_quantity(table, "true_stress" + suffix, stress_units, left);
  if (nominal && truth)
    throw InputError(fmt::format("line {}: nominal and true stress both: keep one", table.header_line));
  if (truth) return {*truth, true};
  if (nominal) return {*nominal, false};
  throw InputError(fmt::format("line {}: no column for the stress among '{}': name it one of {} (or true_stress{}_...)",
                               table.header_line, fmt::join(table.columns, ","),
                               names_with("nominal_stress" + suffix, stress_units), suffix));
}

void refuse_unknown(const Table& table, const std::set<std::string>& left)
{
  if (!left.empty())
    throw InputError(fmt::format("line {}: unknown column '{}': remove it, or see the names in softform fit --help",
                                 table.header_line, *left.begin()));
}

void check_stretch(double stretch, int line)
{
  if (stretch <= 0)
    throw InputError(
        fmt::format("line {}: a stretch of {:g} is impossible: give deformed over undeformed length, which "
                    "is 1 + strain",
                    line, stretch));
  if (stretch > largest_plausible_stretch)
    throw InputError(
        fmt::format("line {}: a stretch of {:g} is implausible: give deformed over undeformed length, not "
                    "a percentage",
                    line, stretch));
}

void check_order(double before, double stretch, int line)
{
  if (stretch == before)
    throw InputError(fmt::format("line {}: the stretch {:g} comes twice: average the two rows", line, stretch));
  if (stretch < before)
    throw InputError(
        fmt::format("line {}: the stretch decreases from {:g} to {:g}: keep the loading curve alone, sorted", line,
                    before, stretch));
}

/// One stretch a row, with its stress.
std::vector<StressObservation> read_simple(const Table& table, TestMode mode)
{
  std::set<std::string> left(table.columns.begin(), table.columns.end());
  const std::size_t stretch_column = require_plain(table, "stretch", left);
  const StressColumn column = require_stress(table, "", left);
  refuse_unknown(table, left);
  std::vector<StressObservation> observations;
  for (const auto& [line, values] : table.rows) {
    const double stretch = values[stretch_column];
    check_stretch(stretch, line);
    if (!observations.empty()) check_order(observations.back().stretches[0], stretch, line);
    const double given = column.factor * values[column.index];
    const double stress = column.is_true ? given / stretch : given;  // incompressible: area shrinks by 1/stretch
    if (stress * (stretch - 1) < 0)
      throw InputError(
          fmt::format("line {}: a stress of {:g} {} at a stretch of {:g} has the wrong sign: tension is "
                      "positive above 1, compression negative below",
                      line, values[column.index], column.unit, stretch));
    observations.push_back({stretches_of(mode, stretch), 0, stress, line});
  }
  return observations;
}

/// Two stretches a row and both stresses.
std::vector<StressObservation> read_biaxial(const Table& table)
{
  std::set<std::string> left(table.columns.begin(), table.columns.end());
  const std::array<std::size_t, 2> stretch{require_plain(table, "stretch_1", left),
                                           require_plain(table, "stretch_2", left)};
  const std::array<StressColumn, 2> stress{require_stress(table, "_1", left), require_stress(table, "_2", left)};
  refuse_unknown(table, left);
  if (stress[0].unit != stress[1].unit || stress[0].is_true != stress[1].is_true)
    throw InputError(fmt::format("line {}: the columns '{}' and '{}' mix units: use one for both", table.header_line,
                                 table.columns[stress[0].index], table.columns[stress[1].index]));
  std::vector<StressObservation> observations;
  std::set<std::pair<double, double>> seen;
  for (const auto& [line, values] : table.rows) {
    const Stretches l(values[stretch[0]], values[stretch[1]]);
    for (const double each : l) check_stretch(each, line);
    if (!seen.insert({l[0], l[1]}).second)
      throw InputError(fmt::format("line {}: the stretches {:g}, {:g} come twice: average the rows", line, l[0], l[1]));
    for (const int i : {0, 1}) {
      const auto& column = stress[std::size_t(i)];
      const double given = column.factor * values[column.index];
      observations.push_back({l, i, column.is_true ? given / l[i] : given, line});
    }
  }
  return observations;
}

/// Pressure, radius of curvature and stretch at the pole of an inflated sheet.
std::vector<StressObservation> read_inflation(const Table& table)
{
  std::set<std::string> left(table.columns.begin(), table.columns.end());
  Units pressure_units = stress_units;
  const auto mercury = table.keys.find("mmhg");
  pressure_units["mmhg"] =
      mercury == table.keys.end() ? 133.322 : parse_pressure(mercury->second.substr(0, mercury->second.find('(')));
  const std::size_t stretch_column = require_plain(table, "stretch", left);
  const FoundColumn pressure = require_quantity(table, "pressure", pressure_units, left);
  const FoundColumn radius = require_quantity(table, "pole_radius", length_units, left);
  refuse_unknown(table, left);
  if (!table.keys.count("thickness"))
    throw InputError("the sheet's thickness is missing: add a line such as '# thickness: 0.5 mm' at the top");
  const double thickness = parse_length(table.keys.at("thickness"));
  if (!(thickness > 0)) throw InputError("the sheet's thickness must be positive: correct its line at the top");
  std::vector<StressObservation> observations;
  for (const auto& [line, values] : table.rows) {
    const double stretch = values[stretch_column], p = pressure.factor * values[pressure.index],
                 r = radius.factor * values[radius.index];
    check_stretch(stretch, line);
    if (stretch < 1 || p < 0 || r <= 0)
      throw InputError(
          fmt::format("line {}: an inflated sheet has a stretch of at least 1, a pressure that is not "
                      "negative and a positive radius: correct it",
                      line));
    if (!observations.empty()) check_order(observations.back().stretches[0], stretch, line);
    observations.push_back(
        {stretches_of(TestMode::Inflation, stretch), 0, pole_stress(p, thickness, r, stretch), line});
  }
  return observations;
}

std::vector<StressObservation> read_observations(const Table& table, TestMode mode)
{
  if (mode == TestMode::Biaxial) return read_biaxial(table);
  if (mode == TestMode::Inflation) return read_inflation(table);
  return read_simple(table, mode);
}

void check_plausible(const RubberTest& test, std::size_t points)
{
  if (points < fewest_points)
    throw InputError(fmt::format("{} points are too few: at least {} are needed", points, fewest_points));
  const double largest = test.largest_stress();
  if (largest < smallest_plausible_stress || largest > largest_plausible_stress) {
    const auto at =
        std::max_element(test.observations.begin(), test.observations.end(),
                         [](const auto& a, const auto& b) { return std::abs(a.stress) < std::abs(b.stress); });
    throw InputError(
        fmt::format("line {}: the largest stress, {:g} Pa, is implausible for a rubber: check the unit in "
                    "the column's name",
                    at->line, largest));
  }
  for (const auto& [stretches, direction, stress, line] : test.observations)
    if ((stretches == 1).all() && std::abs(stress) > largest_stress_at_rest * largest)
      throw InputError(
          fmt::format("line {}: a stress of {:g} Pa at rest, where there is none: subtract the offset, or measure the "
                      "stretch from the unloaded length",
                      line, stress));
}

constexpr std::array all_modes{TestMode::Uniaxial, TestMode::Equibiaxial, TestMode::PureShear, TestMode::Biaxial,
                               TestMode::Inflation};

TestMode parse_mode(const std::string& name)
{
  for (const TestMode mode : all_modes)
    if (name == to_string(mode)) return mode;
  throw InputError(
      fmt::format("its header says 'mode: {}': use uniaxial, equibiaxial, pure_shear, biaxial, inflation", name));
}

RubberTest test_from(const Table& table, TestMode mode, const fs::path& file)
{
  if (table.keys.count("mode") && parse_mode(table.keys.at("mode")) != mode)
    throw InputError(fmt::format("its header says 'mode: {}', but it was given as {}: use the option of its mode",
                                 table.keys.at("mode"), to_string(mode)));
  RubberTest test;
  test.mode = mode;
  test.name = file.filename().string();
  test.citation = table.keys.count("citation") ? table.keys.at("citation") : "";
  test.observations = read_observations(table, mode);
  check_plausible(test, table.rows.size());
  return test;
}

/// Puts the file's name before whatever is wrong with it.
template <class Body>
RubberTest naming(const fs::path& file, const Body& body)
{
  const std::string text = read_text(file);
  try {
    return body(parse_table(text));
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", file.string(), error.what()));
  }
}

}  // namespace

const char* to_string(TestMode mode)
{
  switch (mode) {
    case TestMode::Uniaxial: return "uniaxial";
    case TestMode::Equibiaxial: return "equibiaxial";
    case TestMode::PureShear: return "pure_shear";
    case TestMode::Biaxial: return "biaxial";
    case TestMode::Inflation: return "inflation";
  }
  return "";
}

Stretches stretches_of(TestMode mode, double stretch)
{
  if (mode == TestMode::Uniaxial) return {stretch, 1 / std::sqrt(stretch)};
  if (mode == TestMode::PureShear) return {stretch, 1};
  return {stretch, stretch};
}

double RubberTest::largest_stress() const
{
  double largest = 0;
  for (const StressObservation& observation : observations) largest = std::max(largest, std::abs(observation.stress));
  return largest;
}

RubberTest read_rubber_test(const fs::path& file, TestMode mode)
{
  return naming(file, [&](const Table& table) { return test_from(table, mode, file); });
}

RubberTest load_rubber_test(const std::string& name)
{
  const fs::path file = fs::path(SOFTFORM_SOURCE_DATA_DIR) / "rubber" / (name + ".csv");
  return naming(file, [&](const Table& table) {
    if (!table.keys.count("mode")) throw InputError("says no mode: add a line '# mode: ...' at the top");
    return test_from(table, parse_mode(table.keys.at("mode")), file);
  });
}

}  // namespace softform
