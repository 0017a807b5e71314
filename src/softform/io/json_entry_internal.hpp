#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "softform/core/error.hpp"
#include "softform/core/types.hpp"

namespace softform {

/// What is at a place in a JSON file of a user's; errors name the place.
struct JsonEntry {
  const nlohmann::json& json;
  std::string place;

  [[noreturn]] void refuse(const std::string& problem) const { throw InputError(place + ": " + problem); }

  void require_keys(const std::vector<std::string>& required, const std::vector<std::string>& optional) const
  {
    if (!json.is_object()) refuse(fmt::format("must be an object with the keys {}", fmt::join(required, ", ")));
    for (const auto& [key, value] : json.items())
      if (std::count(required.begin(), required.end(), key) + std::count(optional.begin(), optional.end(), key) == 0)
        refuse(fmt::format("unknown key '{}': use {}{}{}", key, fmt::join(required, ", "),
                           required.empty() || optional.empty() ? "" : ", ", fmt::join(optional, ", ")));
    for (const std::string& key : required)
      if (!json.contains(key)) refuse(fmt::format("the key '{}' is missing: add it", key));
  }

  bool has(const std::string& key) const { return json.contains(key); }
  JsonEntry at(const std::string& key) const { return {json.at(key), fmt::format("{}, '{}'", place, key)}; }

  /// The entries of a list under `key`, each with its own place; none where there is no such key.
  std::vector<JsonEntry> list(const std::string& key, const std::string& item) const
  {
    std::vector<JsonEntry> entries;
    if (!json.contains(key)) return entries;
    if (!json.at(key).is_array()) at(key).refuse("must be a list");
    for (std::size_t i = 0; i < json.at(key).size(); ++i)
      entries.push_back({json.at(key)[i], fmt::format("{}, {} {}", place, item, i + 1)});
    return entries;
  }

  double number() const
  {
    if (!json.is_number() || !std::isfinite(json.get<double>())) refuse(json.dump() + " is not a number");
    return json.get<double>();
  }

  int integer() const
  {
    if (!json.is_number_integer() || std::abs(json.get<double>()) > 1e9) refuse(json.dump() + " is not a whole number");
    return json.get<int>();
  }

  std::string text() const
  {
    if (!json.is_string() || json.get<std::string>().empty()) refuse(json.dump() + " is not a text in quotes");
    return json.get<std::string>();
  }

  /// A value with its unit, such as "3mm", by one of the parsers of core/units.hpp.
  double quantity(double (*parse)(const std::string&)) const
  {
    try {
      return parse(text());
    } catch (const InputError& error) {
      if (std::string(error.what()).starts_with(place)) throw;
      refuse(error.what());
    }
  }

  Vec3 point() const
  {
    if (!json.is_array() || json.size() != 3) refuse(json.dump() + " is not a point: write [x, y, z]");
    Vec3 p;
    for (Eigen::Index k = 0; k < 3; ++k) p[k] = JsonEntry{json[static_cast<std::size_t>(k)], place}.number();
    return p;
  }
};

}  // namespace softform
