#include "softform/io/model_file.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "softform/core/error.hpp"
#include "softform/core/units.hpp"
#include "softform/io/text_file.hpp"

namespace softform {

const char* const model_file_help =
    R"(MODEL is JSON: a solid built of parts in their order, each melting into those before it.
  {
    "comment": "...",                             optional, here and in every part
    "unit": "mm",                                 of all lengths: um, mm, cm, m or in
    "blend": 4,                                   over which length parts melt together; optional, here and per part [0]
    "parts": [
      {"shape": "tube",                           a ball, a round cone, or balls along a smooth curve:
       "balls": [[x, y, z, radius], ...]},        one, two or more
      {"shape": "ellipsoid", "center": [x, y, z], "radii": [a, b, c]},
      {"shape": "box", "center": [x, y, z], "sizes": [a, b, c], "rounding": 2},
      {"shape": "torus", "center": [x, y, z], "axis": [0, 0, 1], "radii": [ring, tube]}
    ]
  }
Every part may also have
  "mirror": true                                  its reflection at the plane x = 0 belongs to it
  "remove": true                                  it is taken away from the parts before it
Ellipsoids and boxes may be turned about their centre, by an angle in degrees about an axis:
  "turn": {"axis": [1, 0, 0], "angle": 30})";

namespace {

using Json = nlohmann::json;

/// A JSON object and the words for where it stands; lengths come out in metres. Refuses keys beyond the known ones.
class Object {
 public:
  Object(const Json& json, std::string where, double unit, std::vector<std::string> known)
      : json_(json), where_(std::move(where)), unit_(unit)
  {
    if (!json.is_object()) fail("must be an object in braces");
    for (const auto& [key, value] : json.items())
      if (std::find(known.begin(), known.end(), key) == known.end())
        fail(fmt::format("unknown key '{}': use {}", key, fmt::join(known, ", ")));
  }

  [[noreturn]] void fail(const std::string& what) const { throw InputError(where_ + what); }

  bool has(const char* key) const { return json_.contains(key); }
  const Json& at(const char* key) const
  {
    if (!has(key)) fail(fmt::format("the key '{}' is missing: add it", key));
    return json_[key];
  }
  /// A list of `count` finite numbers, in the file's unit.
  std::vector<double> numbers(const Json& list, const char* key, std::size_t count) const
  {
    const auto is_number = [](const Json& value) { return value.is_number() && std::isfinite(value.get<double>()); };
    if (!list.is_array() || list.size() != count || !std::all_of(list.begin(), list.end(), is_number))
      fail(fmt::format("'{}' must be a list of {} numbers, not {}", key, count, list.dump()));
    return list.get<std::vector<double>>();
  }
  Vec3 vector(const char* key) const { return Eigen::Map<const Vec3>(numbers(at(key), key, 3).data()); }
  Vec3 point(const char* key) const { return unit_ * vector(key); }
  Vec3 direction(const char* key) const
  {
    const Vec3 v = vector(key);
    if (!(v.norm() > 0)) fail(fmt::format("'{}' is zero: it must be a direction", key));
    return v.normalized();
  }
  std::vector<double> sizes(const char* key, std::size_t count) const
  {
    std::vector<double> values = numbers(at(key), key, count);
    for (double& value : values) {
      if (!(value > 0)) fail(fmt::format("'{}' has the length {}: it must be positive", key, value));
      value *= unit_;
    }
    return values;
  }
  /// A length that may be zero, and may be missing.
  double length(const char* key, double otherwise) const
  {
    if (!has(key)) return otherwise;
    const double value = number(key);
    if (!(value >= 0)) fail(fmt::format("'{}' is {}: it must not be negative", key, value));
    return unit_ * value;
  }
  double number(const char* key) const
  {
    if (!at(key).is_number()) fail(fmt::format("'{}' must be a number, not {}", key, at(key).dump()));
    return at(key).get<double>();
  }
  bool flag(const char* key) const
  {
    if (!has(key)) return false;
    if (!at(key).is_boolean()) fail(fmt::format("'{}' must be true or false, not {}", key, at(key).dump()));
    return at(key).get<bool>();
  }
  std::string text(const char* key) const
  {
    if (!at(key).is_string()) fail(fmt::format("'{}' must be a text in quotes, not {}", key, at(key).dump()));
    return at(key).get<std::string>();
  }
  const Json& list(const char* key) const
  {
    if (!at(key).is_array() || at(key).empty()) fail(fmt::format("'{}' must be a list that is not empty", key));
    return at(key);
  }
  Ball ball(const Json& json) const
  {
    const std::vector<double> b = numbers(json, "balls", 4);
    if (!(b[3] > 0)) fail(fmt::format("'balls' has the radius {}: it must be positive", b[3]));
    return {unit_ * Vec3(b[0], b[1], b[2]), unit_ * b[3]};
  }
  Eigen::Matrix3d axes() const
  {
    if (!has("turn")) return Eigen::Matrix3d::Identity();
    const Object turn(at("turn"), where_ + "'turn': ", unit_, {"axis", "angle"});
    const double angle = turn.number("angle") * std::numbers::pi / 180;
    return Eigen::AngleAxisd(angle, turn.direction("axis")).toRotationMatrix();
  }

 private:
  const Json& json_;
  std::string where_;
  double unit_;
};

Primitive tube_from(const Object& part)
{
  std::vector<Ball> balls;
  for (const Json& json : part.list("balls")) {
    balls.push_back(part.ball(json));
    if (balls.size() > 1 && balls.back().center == balls[balls.size() - 2].center)
      part.fail("two balls that follow each other have the same centre: leave one out");
  }
  return RoundTube(balls);
}

Primitive ellipsoid_from(const Object& part)
{
  return Ellipsoid{part.point("center"), Vec3(part.sizes("radii", 3).data()), part.axes()};
}

Primitive box_from(const Object& part)
{
  const Vec3 half_sizes = 0.5 * Vec3(part.sizes("sizes", 3).data());
  const double rounding = part.length("rounding", 0);
  if (rounding > half_sizes.minCoeff()) part.fail("'rounding' is more than half the smallest size: make it smaller");
  return RoundedBox{part.point("center"), half_sizes, rounding, part.axes()};
}

Primitive torus_from(const Object& part)
{
  const std::vector<double> radii = part.sizes("radii", 2);
  return Torus{part.point("center"), part.direction("axis"), radii[0], radii[1]};
}

struct Shape {
  const char* name;
  std::vector<std::string> keys;
  Primitive (*make)(const Object&);
};

const std::vector<Shape>& shapes()
{
  static const std::vector<Shape> all{{"tube", {"balls"}, tube_from},
                                      {"ellipsoid", {"center", "radii", "turn"}, ellipsoid_from},
                                      {"box", {"center", "sizes", "rounding", "turn"}, box_from},
                                      {"torus", {"center", "axis", "radii"}, torus_from}};
  return all;
}

const Shape& shape_named(const std::string& name, const std::string& where)
{
  std::vector<std::string> names;
  for (const Shape& shape : shapes()) {
    if (name == shape.name) return shape;
    names.emplace_back(shape.name);
  }
  throw InputError(fmt::format("{}there is no shape '{}': use {}", where, name, fmt::join(names, ", ")));
}

ImplicitModel::Part part_from(const Json& json, const std::string& where, double unit, double blend)
{
  const std::string name = json.is_object() ? json.value("shape", Json()).dump() : "";
  if (name.size() < 2 || name.front() != '"')
    throw InputError(where + "must be an object with a \"shape\": name it, for example \"ellipsoid\"");
  const Shape& shape = shape_named(json["shape"], where);
  std::vector<std::string> known = shape.keys;
  known.insert(known.end(), {"shape", "blend", "mirror", "remove", "comment"});
  const Object part(json, where, unit, known);
  return {shape.make(part), part.length("blend", blend), part.flag("mirror"), part.flag("remove")};
}

ImplicitModel model_from(const Json& json)
{
  const Object header(json, "", 1, {"comment", "unit", "blend", "parts"});
  const double unit = parse_length("1 " + header.text("unit"));
  const Object model(json, "", unit, {"comment", "unit", "blend", "parts"});
  ImplicitModel result;
  for (const Json& part : model.list("parts"))
    result.parts.push_back(
        part_from(part, fmt::format("parts[{}]: ", result.parts.size()), unit, model.length("blend", 0)));
  return result;
}

}  // namespace

ImplicitModel read_model(const std::filesystem::path& file)
{
  try {
    return model_from(Json::parse(read_text(file)));
  } catch (const Json::exception& error) {
    throw InputError(fmt::format("{}: is not valid JSON ({}): correct it there", file.string(), error.what()));
  } catch (const InputError& error) {
    const std::string what = error.what();
    throw InputError(what.starts_with(file.string()) ? what : file.string() + ": " + what);
  }
}

}  // namespace softform
