#include <algorithm>
#include <array>
#include <cctype>
#include <numbers>

#include "softform/characters/bent_bar.hpp"
#include "softform/characters/character_file_internal.hpp"
#include "softform/characters/drawing.hpp"
#include "softform/characters/posed_mesh_file.hpp"
#include "softform/core/units.hpp"

namespace softform::character_file {
namespace {

using Json = nlohmann::json;
using Entry = JsonEntry;

// Names go into file names and tables.
std::string name_from(const Entry& entry)
{
  const std::string name = entry.text();
  const auto is_plain = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '-'; };
  if (!std::all_of(name.begin(), name.end(), is_plain))
    entry.refuse(fmt::format("'{}' goes into file names: use letters, digits, '_' and '-'", name));
  return name;
}

class BodyReader {
 public:
  BodyReader(std::filesystem::path folder, double unit, double& thickness)
      : folder_(std::move(folder)), unit_(unit), thickness_(thickness)
  {}

  Body read(const Entry& body);

 private:
  PosedMesh<2> read_drawing_body(const Entry& body);
  PosedMesh<3> read_bar(const Entry& body) const;
  Body read_mesh_body(const Entry& body);
  std::vector<Bend> bends_from(const Entry& pose, double length) const;

  std::filesystem::path folder_;
  double unit_;
  double& thickness_;
};

Body BodyReader::read(const Entry& body)
{
  if (!body.json.is_object()) body.refuse("must be an object in braces");
  if (body.has("drawing")) return read_drawing_body(body);
  if (body.has("bar")) return read_bar(body);
  if (body.has("mesh")) return read_mesh_body(body);
  body.refuse("one of the keys 'drawing', 'bar' and 'mesh' is needed: add it");
}

PosedMesh<2> BodyReader::read_drawing_body(const Entry& body)
{
  body.require_keys({"drawing", "triangles", "thickness"}, {"poses", "comment"});
  const int triangles = body.at("triangles").integer();
  if (triangles < 50 || triangles > 200'000) body.at("triangles").refuse("give between 50 and 200000");
  thickness_ = positive(body.at("thickness"), parse_length);
  const std::filesystem::path path = folder_ / body.at("drawing").text();
  CharacterDrawing drawing = read_drawing(path);
  if (body.has("poses")) {
    std::vector<CharacterDrawing::Pose> chosen;
    for (const Entry& entry : body.list("poses", "entry")) {
      const auto is_it = [&](const auto& pose) { return pose.name == entry.text(); };
      const auto pose = std::find_if(drawing.poses.begin(), drawing.poses.end(), is_it);
      if (pose == drawing.poses.end()) entry.refuse(fmt::format("{} has no pose '{}'", path.string(), entry.text()));
      chosen.push_back(*pose);
    }
    drawing.poses = std::move(chosen);
  }
  for (const auto& pose : drawing.poses) name_from({Json(pose.name), path.string() + ", a pose's name"});
  try {
    return make_character(drawing, triangles);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", path.string(), error.what()));
  }
}

std::vector<Bend> BodyReader::bends_from(const Entry& pose, double length) const
{
  std::vector<Bend> bends;
  for (const Entry& entry : pose.list("bends", "bend")) {
    const Vec3 numbers = entry.point();  // [begin, end, degrees]
    const Bend bend{unit_ * numbers[0], unit_ * numbers[1], numbers[2] * std::numbers::pi / 180};
    if (!(bend.begin >= 0 && bend.end <= length && bend.end - bend.begin > 2 * bend_fade))
      entry.refuse(fmt::format("{} is [begin, end, degrees]: it must lie on the bar and be longer than {:g} mm",
                               entry.json.dump(), 2e3 * bend_fade));
    bends.push_back(bend);
  }
  return bends;
}

PosedMesh<3> BodyReader::read_bar(const Entry& body) const
{
  body.require_keys({"bar", "cells", "poses"}, {"comment"});
  Vec3 size;
  std::array<int, 3> cells{};
  const std::vector<Entry> sizes = list_of(body, "bar", 3, "size"), counts = list_of(body, "cells", 3, "count");
  for (std::size_t k = 0; k < 3; ++k) {
    size[Eigen::Index(k)] = unit_ * positive(sizes[k]);
    cells[k] = counts[k].integer();
    if (cells[k] < 1 || cells[k] > 1000) counts[k].refuse(fmt::format("{} cells: give 1 to 1000", cells[k]));
  }
  PosedMesh<3> bar{grid<3>(size, cells), {}, {}, {}, {}};
  std::vector<std::vector<Bend>> bends;
  for (const Entry& pose : body.list("poses", "pose")) {
    pose.require_keys({"name", "bends"}, {"comment"});
    bar.names.push_back(name_from(pose.at("name")));
    bends.push_back(bends_from(pose, size.x()));
    bar.targets.push_back(bent_bar(bar.rest, bends.back()));
  }
  require_upright<3>(bar, body.at("poses").place);
  bar.way = [rest = bar.rest, bends](std::size_t pose, double fraction) {
    return bent_bar(rest, bends[pose], fraction);
  };
  return bar;
}

Body BodyReader::read_mesh_body(const Entry& body)
{
  body.require_keys({"mesh", "poses"}, {"thickness", "tetrahedra", "comment"});
  std::vector<PoseFile> poses;
  for (const Entry& pose : body.list("poses", "pose")) {
    pose.require_keys({"name", "file"}, {"comment"});
    poses.push_back({name_from(pose.at("name")), folder_ / pose.at("file").text()});
  }
  const std::filesystem::path mesh = folder_ / body.at("mesh").text();
  if (body.has("thickness")) {
    if (body.has("tetrahedra")) body.at("tetrahedra").refuse("a body with a thickness is planar: leave one out");
    thickness_ = positive(body.at("thickness"), parse_length);
    return read_posed_mesh<2>(mesh, poses, unit_);
  }
  const int tetrahedra = body.has("tetrahedra") ? body.at("tetrahedra").integer() : 0;
  if (tetrahedra < 0) body.at("tetrahedra").refuse("how many there should be: it must not be negative");
  return read_posed_mesh<3>(mesh, poses, unit_, tetrahedra);
}

}  // namespace

Body read_body(const Entry& body, const std::filesystem::path& folder, double unit, double& thickness)
{
  return BodyReader(folder, unit, thickness).read(body);
}

double positive(const Entry& entry)
{
  const double value = entry.number();
  if (!(value > 0)) entry.refuse(fmt::format("{:g} must be above 0", value));
  return value;
}

double positive(const Entry& entry, double (*parse)(const std::string&))
{
  const double value = entry.quantity(parse);
  if (!(value > 0)) entry.refuse(fmt::format("{} must be above 0", entry.text()));
  return value;
}

std::vector<Entry> list_of(const Entry& entry, const std::string& key, std::size_t count, const std::string& item)
{
  std::vector<Entry> entries = entry.list(key, fmt::format("'{}', {}", key, item));
  if (count > 0 && entries.size() != count)
    entry.at(key).refuse(fmt::format("{} entries: give {}", entries.size(), count));
  return entries;
}

}  // namespace softform::character_file
