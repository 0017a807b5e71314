#include "layout.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "softform/core/error.hpp"
#include "softform/io/text_file.hpp"

namespace softform::render {

const char* const layout_help = R"(LAYOUT is JSON: a grid of surfaces, a row a model, a column a kind of shape.
  {
    "width": 2400,                                 optional, pixels
    "blocks": 1,                                   optional: rows in so many blocks side by side
    "columns": [{"title": "Target",                optional
                 "color": "#b8bec8"}, ...],        optional, #rrggbb
    "rows": [{"title": "Bunny",                    optional
              "view": [0, -1, 0.2],                optional, from the model to the eye [0, -1, 0]
              "up": [0, 0, 1],                     optional
              "cells": [CELL or null, ...]}, ...]  one a column
  }
CELL:
  {"surface": "bunny_target.vtp",                  a file of the results folder
   "title": "...", "color": "#rrggbb", "edges": true,                                  all optional
   "scalar": {"field": "distance", "title": "distance to the target", "unit": "cm",    optional: show a field
              "factor": 100,                       optional: shown = factor * stored
              "range": [0, 1],                     optional, in the unit shown; else from zero (coolwarm: about zero)
              "map": "viridis"}}                   optional: viridis (sequential), coolwarm (diverging) or
                                                   categories (whole numbers; no colour bar)
The cells of a row share the view, in parallel projection, and the scale.)";

namespace {

using nlohmann::json;

/// A JSON object and the words for where it stands; refuses keys beyond the known ones.
class Object {
 public:
  Object(const json& value, std::string where, std::initializer_list<const char*> known)
      : value_(value), where_(std::move(where))
  {
    if (!value.is_object()) fail("must be an object in braces");
    for (const auto& [key, unused] : value.items())
      if (std::find(known.begin(), known.end(), key) == known.end())
        fail(fmt::format("unknown key '{}'; known are {}", key, fmt::join(known, ", ")));
  }

  bool has(const char* key) const { return value_.contains(key); }
  const json& at(const char* key) const
  {
    if (!has(key)) fail(fmt::format("needs the key '{}'", key));
    return value_[key];
  }
  /// Sets the target when the key is there; says which type is wanted when it has another one.
  template <class T>
  void read(const char* key, T& target) const
  {
    if (!has(key)) return;
    try {
      value_[key].get_to(target);
    } catch (const json::exception& error) {
      fail(fmt::format("'{}' has the wrong type: {}", key, error.what()));
    }
  }
  const json& array(const char* key) const
  {
    if (!at(key).is_array() || at(key).empty()) fail(fmt::format("'{}' must be a list that is not empty", key));
    return at(key);
  }
  std::string child(const char* key, std::size_t index) const { return fmt::format("{}: {}[{}]", where_, key, index); }
  const std::string& where() const { return where_; }
  [[noreturn]] void fail(const std::string& what) const { throw InputError(fmt::format("{}: {}", where_, what)); }

 private:
  const json& value_;
  std::string where_;
};

Color read_color(const Object& object)
{
  std::string text;
  object.read("color", text);
  if (text.size() != 7 || text[0] != '#' || text.find_first_not_of("0123456789abcdefABCDEF", 1) != std::string::npos)
    object.fail(fmt::format("color '{}' must look like #b8bec8", text));
  const auto channel = [&](std::size_t start) { return std::stoi(text.substr(start, 2), nullptr, 16) / 255.0; };
  return {channel(1), channel(3), channel(5)};
}

Scalar read_scalar(const json& value, const std::string& where)
{
  const Object object(value, where + ": scalar", {"field", "title", "unit", "factor", "range", "map"});
  Scalar scalar;
  object.at("field");
  object.read("field", scalar.field);
  object.read("title", scalar.title);
  object.read("unit", scalar.unit);
  object.read("factor", scalar.factor);
  std::string map = "viridis";
  object.read("map", map);
  if (map != "viridis" && map != "coolwarm" && map != "categories")
    object.fail(fmt::format("map '{}' must be viridis, coolwarm or categories", map));
  scalar.map = map == "viridis" ? ColorMap::Viridis : map == "coolwarm" ? ColorMap::Coolwarm : ColorMap::Categories;
  if (object.has("range")) {
    object.read("range", scalar.range.emplace());
    if (!((*scalar.range)[0] < (*scalar.range)[1])) object.fail("range must be [low, high] with low < high");
  }
  return scalar;
}

std::optional<Cell> read_cell(const json& value, const std::string& where)
{
  if (value.is_null()) return std::nullopt;
  const Object object(value, where, {"surface", "title", "color", "edges", "scalar"});
  Cell cell;
  object.at("surface");
  object.read("surface", cell.surface);
  object.read("title", cell.title);
  object.read("edges", cell.edges);
  if (object.has("color")) cell.color = read_color(object);
  if (object.has("scalar")) cell.scalar = read_scalar(object.at("scalar"), where);
  return cell;
}

bool are_parallel(const std::array<double, 3>& a, const std::array<double, 3>& b)
{
  const double x = a[1] * b[2] - a[2] * b[1];
  const double y = a[2] * b[0] - a[0] * b[2];
  const double z = a[0] * b[1] - a[1] * b[0];
  const auto norm = [](double p, double q, double r) { return std::sqrt(p * p + q * q + r * r); };
  return norm(x, y, z) <= 1e-6 * norm(a[0], a[1], a[2]) * norm(b[0], b[1], b[2]);
}

Row read_row(const json& value, const std::string& where, std::size_t column_count)
{
  const Object object(value, where, {"title", "view", "up", "cells"});
  Row row;
  object.read("title", row.title);
  object.read("view", row.view);
  object.read("up", row.up);
  if (are_parallel(row.view, row.up)) object.fail("view and up must be two different directions");
  const json& cells = object.array("cells");
  if (cells.size() != column_count)
    object.fail(fmt::format("has {} cells for {} columns; use null for an empty one", cells.size(), column_count));
  for (std::size_t k = 0; k < cells.size(); ++k) row.cells.push_back(read_cell(cells[k], object.child("cells", k)));
  return row;
}

}  // namespace

Layout read_layout(const std::filesystem::path& file)
{
  json value;
  try {
    value = json::parse(read_text(file));
  } catch (const json::exception& error) {
    throw InputError(fmt::format("{}: is not JSON: {}", file.string(), error.what()));
  }
  const Object object(value, file.string(), {"width", "blocks", "columns", "rows"});
  Layout layout;
  object.read("width", layout.width);
  if (layout.width < 200 || layout.width > 8000) object.fail("width must be 200 to 8000 pixels");
  object.read("blocks", layout.blocks);
  if (layout.blocks < 1 || layout.blocks > 4) object.fail("blocks must be 1 to 4");
  const json& columns = object.array("columns");
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const Object column(columns[k], object.child("columns", k), {"title", "color"});
    ColumnStyle& style = layout.columns.emplace_back();
    column.read("title", style.title);
    if (column.has("color")) style.color = read_color(column);
  }
  const json& rows = object.array("rows");
  for (std::size_t k = 0; k < rows.size(); ++k)
    layout.rows.push_back(read_row(rows[k], object.child("rows", k), columns.size()));
  return layout;
}

}  // namespace softform::render
