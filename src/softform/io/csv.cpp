#include "softform/io/csv.hpp"

#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace softform {
namespace {

/// Quotes a field where CSV asks for it.
std::string field(const std::string& text)
{
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

}  // namespace

void CsvTable::add_row(std::vector<double> values)
{
  if (values.size() != columns_.size())
    throw std::logic_error(fmt::format("a row of {} values in a table of {} columns", values.size(), columns_.size()));
  rows_.push_back(std::move(values));
}

std::string CsvTable::text() const
{
  std::vector<std::string> header;
  for (const auto& [name, unit] : columns_)
    header.push_back(field(unit.empty() || unit == "1" ? name : fmt::format("{} [{}]", name, unit)));
  std::string text = fmt::format("{}\n", fmt::join(header, ","));
  for (const auto& row : rows_) text += fmt::format("{}\n", fmt::join(row, ","));
  return text;
}

std::string metrics_csv(const std::vector<Metric>& metrics)
{
  std::string text = "metric,value,unit\n";
  for (const auto& [name, value, unit] : metrics) text += fmt::format("{},{},{}\n", field(name), value, field(unit));
  return text;
}

}  // namespace softform
