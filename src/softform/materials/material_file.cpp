#include "softform/materials/material_file.hpp"

#include <cstdlib>
#include <fstream>
#include <map>
#include <set>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "softform/core/error.hpp"
#include "softform/core/units.hpp"
#include "softform/io/text_file.hpp"
#include "softform/materials/registry.hpp"

namespace softform {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

std::vector<fs::path> material_folders()
{
  std::vector<fs::path> folders;
  if (const char* data = std::getenv("SOFTFORM_DATA")) folders.emplace_back(fs::path(data) / "materials");
  folders.emplace_back(fs::path(SOFTFORM_SOURCE_DATA_DIR) / "materials");
  folders.emplace_back(fs::path(SOFTFORM_INSTALLED_DATA_DIR) / "materials");
  return folders;
}

std::string known_names()
{
  std::set<std::string> names;
  for (const fs::path& folder : material_folders()) {
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(folder, none))
      if (entry.path().extension() == ".json") names.insert(entry.path().stem().string());
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

Json parse_file(const fs::path& file)
{
  std::ifstream stream(file);
  if (!stream || fs::is_directory(file)) throw InputError("no such file, or it cannot be read: check the name");
  try {
    return Json::parse(stream);
  } catch (const Json::parse_error& error) {
    throw InputError(fmt::format("is not valid JSON ({}): correct it there", error.what()));
  }
}

/// The value of a required key; `type` names the JSON type that it must have.
const Json& member(const Json& object, const std::string& key, Json::value_t type)
{
  if (!object.contains(key)) throw InputError(fmt::format("the key '{}' is missing: add it", key));
  const Json& value = object.at(key);
  if (value.type() != type)
    throw InputError(fmt::format("'{}' must be {}, not {}", key, Json(type).type_name(), value.dump()));
  return value;
}

double parse_parameter(const std::string& name, const std::string& unit, const Json& value)
{
  if (unit == "Pa") {
    if (!value.is_string())
      throw InputError(
          fmt::format("{} = {} has no unit: write it as a string, for example \"0.16 MPa\"", name, value.dump()));
    return parse_pressure(value.get<std::string>());
  }
  if (!value.is_number())
    throw InputError(fmt::format("{} = {} must be a plain number: it has no unit", name, value.dump()));
  return value.get<double>();
}

std::unique_ptr<Material> material_from(const Json& json)
{
  if (!json.is_object())
    throw InputError(
        "must hold an object {\"model\": ..., \"parameters\": "
        "{...}, \"source\": ...}");
  for (const auto& [key, value] : json.items()) {
    if (key != "model" && key != "parameters" && key != "source")
      throw InputError(fmt::format("unknown key '{}': use model, parameters, source", key));
  }
  member(json, "source", Json::value_t::string);
  const auto model_name = member(json, "model", Json::value_t::string).get<std::string>();
  const Json& given = member(json, "parameters", Json::value_t::object);

  std::map<std::string, std::string> units;
  for (const auto& parameter : expected_parameters(find_material_model(model_name), given.size()))
    units[parameter.name] = parameter.unit;
  std::map<std::string, double> parameters;
  for (const auto& [name, value] : given.items()) {
    const auto unit = units.find(name);
    // An unknown name is left for make_material to refuse.
    parameters[name] = unit == units.end() ? 0.0 : parse_parameter(name, unit->second, value);
  }
  return make_material(model_name, parameters);
}

}  // namespace

std::unique_ptr<Material> read_material(const fs::path& file)
{
  try {
    return material_from(parse_file(file));
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", file.string(), error.what()));
  }
}

void write_material(const fs::path& file, const Material& material, const std::string& source)
{
  nlohmann::ordered_json json;
  json["model"] = material.model();
  for (const MaterialParameter& parameter : material.parameters()) {
    auto& value = json["parameters"][parameter.name];
    if (parameter.unit == "Pa")
      value = fmt::format("{} Pa", parameter.value);
    else
      value = parameter.value;
  }
  json["source"] = source;
  write_text(file, json.dump(2) + '\n');
}

std::unique_ptr<Material> load_material(const std::string& name_or_path)
{
  if (fs::exists(name_or_path)) return read_material(name_or_path);
  const bool is_name = fs::path(name_or_path).filename() == name_or_path && !fs::path(name_or_path).has_extension();
  if (is_name) {
    for (const fs::path& folder : material_folders()) {
      const fs::path file = folder / (name_or_path + ".json");
      if (fs::exists(file)) return read_material(file);
    }
  }
  throw InputError(
      fmt::format("{}: no such material file, nor a known "
                  "material: give a JSON file or one of {}",
                  name_or_path, known_names()));
}

}  // namespace softform
