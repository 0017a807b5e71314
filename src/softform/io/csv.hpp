#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace softform {

/// A column's name and unit; "1" (or nothing) is dimensionless.
struct Column {
  std::string name;
  std::string unit = "1";
};

/// A table of numbers with named columns, written as `iteration,objective [J],...`.
class CsvTable {
 public:
  explicit CsvTable(std::vector<Column> columns) : columns_(std::move(columns)) {}

  /// One value a column. Throws std::logic_error when the count differs.
  void add_row(std::vector<double> values);

  /// Header and rows; numbers in the shortest form that reads back to the same bits.
  std::string text() const;

  int row_count() const { return static_cast<int>(rows_.size()); }

 private:
  std::vector<Column> columns_;
  std::vector<std::vector<double>> rows_;
};

/// A named result with its unit ("1" for dimensionless).
struct Metric {
  std::string name;
  double value = 0;
  std::string unit = "1";
};

/// `metric,value,unit`, one line a metric.
std::string metrics_csv(const std::vector<Metric>& metrics);

}  // namespace softform
