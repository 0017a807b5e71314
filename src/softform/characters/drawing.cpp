#include "softform/characters/drawing.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "softform/core/error.hpp"
#include "softform/core/units.hpp"
#include "softform/io/text_file.hpp"
#include "softform/mesh/triangulate.hpp"

namespace softform {
namespace {

using Json = nlohmann::json;
using Vec2 = Eigen::Vector2d;

constexpr int links_of_a_bone = 16;  // a link turns by a sixteenth of its bone's bend: smooth to the eye
constexpr double radians_per_degree = std::numbers::pi / 180;

// The members of an object; refuses keys that are not known and misses those that must be there.
void require_keys(const Json& object, const std::string& where, const std::vector<std::string>& needed,
                  const std::vector<std::string>& optional = {})
{
  if (!object.is_object()) throw InputError(fmt::format("{} must be an object {{...}}", where));
  for (const std::string& key : needed)
    if (!object.contains(key)) throw InputError(fmt::format("{}: the key '{}' is missing: add it", where, key));
  for (const auto& [key, value] : object.items()) {
    const auto is_key = [&k = key](const std::vector<std::string>& keys) {
      return std::find(keys.begin(), keys.end(), k) != keys.end();
    };
    if (!is_key(needed) && !is_key(optional))
      throw InputError(fmt::format("{}: unknown key '{}': use {}{}{}", where, key, fmt::join(needed, ", "),
                                   optional.empty() ? "" : ", ", fmt::join(optional, ", ")));
  }
}

Vec2 point_from(const Json& json, double unit, const std::string& where)
{
  if (!json.is_array() || json.size() < 2 || !json[0].is_number() || !json[1].is_number())
    throw InputError(fmt::format("{}: a point is [x, y], not {}", where, json.dump()));
  return unit * Vec2(json[0].get<double>(), json[1].get<double>());
}

OutlineLoop loop_from(const Json& json, double unit, const std::string& where)
{
  require_keys(json, where, {"points"}, {"mirror"});
  OutlineLoop loop;
  for (std::size_t i = 0; i < json["points"].size(); ++i) {
    const Json& point = json["points"][i];
    const std::string here = fmt::format("{}, point {}", where, i);
    const Vec2 position = point_from(point, unit, here);
    if (point.size() > 3 || (point.size() == 3 && point[2] != "corner"))
      throw InputError(fmt::format("{}: after x and y comes \"corner\" or nothing, not {}", here, point.dump()));
    loop.push_back({position, point.size() == 3});
  }
  if (json.value("mirror", false)) {  // points on the axis x = 0 are not repeated
    for (std::size_t i = loop.size(); i-- > 0;) {
      OutlinePoint point = loop[i];
      if (point.position.x() == 0) continue;
      point.position.x() *= -1;
      loop.push_back(point);
    }
  }
  if (loop.size() < 3) throw InputError(fmt::format("{}: a loop needs three points at least", where));
  return loop;
}

// Equally long links along the smooth curve through the points given.
PlanarPositions joints_from(const Json& path, double unit, const std::string& where)
{
  if (!path.is_array() || path.size() < 2) throw InputError(fmt::format("{}: a path needs two points at least", where));
  // There and back again is a loop whose first half is the path.
  OutlineLoop loop;
  for (const Json& point : path) loop.push_back({point_from(point, unit, where), false});
  loop.front().is_corner = loop.back().is_corner = true;
  for (std::size_t i = loop.size() - 1; i-- > 1;) loop.push_back(loop[i]);
  double length = 0;
  const PlanarPositions fine = sample(loop, 1e-3 * unit * links_of_a_bone);
  for (Eigen::Index i = 0; i < fine.rows(); ++i) length += (fine.row((i + 1) % fine.rows()) - fine.row(i)).norm() / 2;
  return sample(loop, length / links_of_a_bone * (1 + 1e-4)).topRows(links_of_a_bone + 1);
}

int link_nearest_to(const Bone& bone, const Vec2& point)
{
  int nearest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k + 1 < bone.joints.rows(); ++k) {
    const double d = ((bone.joints.row(k) + bone.joints.row(k + 1)) / 2 - point.transpose()).norm();
    if (d < least) {
      least = d;
      nearest = k;
    }
  }
  return nearest;
}

Skeleton skeleton_from(const Json& json, double unit)
{
  Skeleton skeleton;
  for (const auto& entry : json) {
    require_keys(entry, fmt::format("bone {}", skeleton.bones.size()), {"name", "path"}, {"parent"});
    Bone bone;
    bone.name = entry["name"].get<std::string>();
    bone.joints = joints_from(entry["path"], unit, fmt::format("bone '{}'", bone.name));
    if (entry.contains("parent")) {
      const auto parent = std::find_if(skeleton.bones.begin(), skeleton.bones.end(),
                                       [&](const Bone& b) { return b.name == entry["parent"]; });
      if (parent == skeleton.bones.end())
        throw InputError(fmt::format("bone '{}': its parent {} does not come before it: put it there", bone.name,
                                     entry["parent"].dump()));
      bone.parent = static_cast<int>(parent - skeleton.bones.begin());
      bone.parent_link = link_nearest_to(*parent, bone.joints.row(0).transpose());
    }
    skeleton.bones.push_back(std::move(bone));
  }
  return skeleton;
}

CharacterDrawing::Pose pose_from(const Json& json, std::size_t index)
{
  require_keys(json, fmt::format("pose {}", index), {"name", "bends"});
  CharacterDrawing::Pose pose{json["name"].get<std::string>(), {}};
  for (const auto& [bone, degrees] : json["bends"].items()) {
    Bends& bends = pose.bends[bone];
    for (const Json& value : degrees.is_array() ? degrees : Json::array({degrees})) {
      if (!value.is_number())
        throw InputError(fmt::format("pose '{}': bone '{}' bends by {}: give degrees", pose.name, bone, value.dump()));
      bends.push_back(radians_per_degree * value.get<double>());
    }
  }
  return pose;
}

CharacterDrawing::Hold hold_from(const Json& json, double unit, std::size_t index)
{
  const std::string where = fmt::format("hold {}", index);
  if (!json.is_array() || json.size() != 2)
    throw InputError(fmt::format("{}: two corners [[x, y], [x, y]] are a rectangle, not {}", where, json.dump()));
  const Vec2 a = point_from(json[0], unit, where), b = point_from(json[1], unit, where);
  return {a.cwiseMin(b), a.cwiseMax(b)};
}

CharacterDrawing drawing_from(const Json& json)
{
  require_keys(json, "the drawing", {"description", "unit", "outline", "bones", "poses"}, {"holds"});
  const double unit = parse_length(fmt::format("1{}", json["unit"].get<std::string>()));
  CharacterDrawing drawing;
  for (std::size_t i = 0; i < json["outline"].size(); ++i)
    drawing.outline.push_back(loop_from(json["outline"][i], unit, fmt::format("loop {}", i)));
  if (drawing.outline.empty()) throw InputError("the outline has no loop: draw one");
  drawing.skeleton = skeleton_from(json["bones"], unit);
  for (const Json& pose : json["poses"]) drawing.poses.push_back(pose_from(pose, drawing.poses.size()));
  if (json.contains("holds"))
    for (const Json& hold : json["holds"]) drawing.holds.push_back(hold_from(hold, unit, drawing.holds.size()));
  return drawing;
}

// Throws InputError when a rectangle holds no vertex.
FixedDofs held_coordinates(const std::vector<CharacterDrawing::Hold>& holds, const PlanarMesh& mesh)
{
  FixedDofs held;
  for (std::size_t i = 0; i < holds.size(); ++i) {
    if (held.free.size() == 0) held.free = Vec::Ones(mesh.positions.size());
    int count = 0;
    for (int v = 0; v < mesh.vertex_count(); ++v) {
      const Vec2 x = mesh.positions.segment<2>(2 * v);
      if ((x.array() < holds[i].least.array()).any() || (x.array() > holds[i].most.array()).any()) continue;
      held.free.segment<2>(2 * v).setZero();
      ++count;
    }
    if (count == 0) throw InputError(fmt::format("hold {} contains no vertex: make the rectangle larger", i));
  }
  return held;
}

}  // namespace

CharacterDrawing read_drawing(const std::filesystem::path& file)
{
  try {
    return drawing_from(Json::parse(read_text(file)));
  } catch (const Json::exception& error) {
    throw InputError(fmt::format("{}: is no drawing ({}): correct it there", file.string(), error.what()));
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", file.string(), error.what()));
  }
}

CharacterDrawing load_drawing(const std::string& name)
{
  return read_drawing(std::filesystem::path(SOFTFORM_SOURCE_DATA_DIR) / "characters" / (name + ".json"));
}

PosedCharacter make_character(const CharacterDrawing& drawing, int triangle_count)
{
  PosedCharacter character{triangulate_to_count(drawing.outline, triangle_count), {}, {}, {}, {}};
  character.held = held_coordinates(drawing.holds, character.rest);
  const Eigen::MatrixXd weights = link_weights(drawing.skeleton, character.rest);
  for (const CharacterDrawing::Pose& pose : drawing.poses) {
    character.names.push_back(pose.name);
    character.targets.push_back(posed(drawing.skeleton, character.rest, weights, pose.bends));
  }
  require_upright<2>(character, "the drawing");
  character.way = [drawing, weights, rest = character.rest](std::size_t pose, double fraction) {
    SkeletonPose bends = drawing.poses[pose].bends;
    for (auto& [bone, angles] : bends)
      for (double& angle : angles) angle *= fraction;
    return posed(drawing.skeleton, rest, weights, bends);
  };
  return character;
}

}  // namespace softform
