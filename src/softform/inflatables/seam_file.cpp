#include "softform/inflatables/seam_file.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "softform/core/error.hpp"
#include "softform/io/json_entry_internal.hpp"
#include "softform/io/text_file.hpp"

namespace softform {
namespace {

using Json = nlohmann::json;

using Entry = JsonEntry;

class PlanReader {
 public:
  explicit PlanReader(const std::string& file) { plan_.source = file; }

  SeamPlan read(const Json& json)
  {
    const Entry file{json, plan_.source};
    file.require_keys({"seams"}, {"comment", "walls", "panels"});
    for (const Entry& entry : file.list("seams", "seam")) add_seam(entry);
    if (plan_.seams.empty()) file.at("seams").refuse("holds no seam: draw at least one");
    for (const Entry& entry : file.list("walls", "wall")) add_wall(entry);
    for (const Entry& entry : file.list("panels", "panel")) {
      entry.require_keys({"name", "inside"}, {"comment"});
      plan_.panels.push_back({entry.at("name").text(), entry.at("inside").point()});
    }
    return std::move(plan_);
  }

 private:
  void add_seam(const Entry& numbered)
  {
    numbered.require_keys({"name", "points"}, {"closed", "weight", "comment"});
    DrawnSeam seam;
    seam.name = numbered.at("name").text();
    const Entry entry{numbered.json, fmt::format("{}, seam '{}'", plan_.source, seam.name)};
    if (names_.count(seam.name) > 0) entry.refuse("another seam has this name: choose one for each");
    if (entry.json.contains("weight")) seam.weight = entry.at("weight").number();
    if (seam.weight < 0) entry.at("weight").refuse("is negative: 0 lets the seam slide, 1 holds it");
    if (entry.json.contains("closed")) {
      if (!entry.json.at("closed").is_boolean()) entry.at("closed").refuse("must be true or false");
      seam.is_closed = entry.json.at("closed").get<bool>();
    }
    for (const Entry& point : entry.list("points", "point")) seam.points.push_back(read_point(point));
    const std::size_t least = seam.is_closed ? 3 : 2;
    if (seam.points.size() < least)
      entry.refuse(fmt::format("has {} points: give at least {}", seam.points.size(), least));
    names_.insert(seam.name);
    plan_.seams.push_back(std::move(seam));
  }

  SeamPoint read_point(const Entry& entry) const
  {
    SeamPoint point;
    if (entry.json.is_array()) {
      point.position = entry.point();
      return point;
    }
    entry.require_keys({"on"}, {"at", "near"});
    point.on = require_seam(entry.at("on"));
    if (entry.json.contains("at") == entry.json.contains("near"))
      entry.refuse("needs either \"at\", a fraction of the seam's length, or \"near\", a point");
    if (entry.json.contains("near")) {
      point.position = entry.at("near").point();
    } else {
      point.fraction = entry.at("at").number();
      if (*point.fraction < 0 || *point.fraction > 1) entry.at("at").refuse("must lie between 0 and 1");
    }
    return point;
  }

  void add_wall(const Entry& entry)
  {
    entry.require_keys({"name", "between"}, {"comment"});
    const auto ends = entry.list("between", "'between'");
    if (ends.size() != 2) entry.at("between").refuse("must name two seams");
    DrawnWall wall{entry.at("name").text(), {require_seam(ends[0]), require_seam(ends[1])}};
    if (wall.between[0] == wall.between[1]) entry.at("between").refuse("names one seam twice: name two");
    plan_.walls.push_back(std::move(wall));
  }

  std::string require_seam(const Entry& entry) const
  {
    const std::string name = entry.text();
    if (names_.count(name) == 0) {
      const std::string known = names_.empty() ? "there is none" : fmt::format("there are {}", fmt::join(names_, ", "));
      entry.refuse(fmt::format("no seam above is called '{}'; {}", name, known));
    }
    return name;
  }

  SeamPlan plan_;
  std::set<std::string> names_;
};

}  // namespace

SeamPlan read_seam_file(const std::filesystem::path& file)
{
  const std::string text = read_text(file);
  Json json;
  try {
    json = Json::parse(text);
  } catch (const Json::parse_error& error) {
    throw InputError(fmt::format("{}: is not valid JSON ({}): correct it there", file.string(), error.what()));
  }
  return PlanReader(file.string()).read(json);
}

SeamPlan scaled(SeamPlan plan, double factor)
{
  for (DrawnSeam& seam : plan.seams)
    for (SeamPoint& point : seam.points) point.position *= factor;
  for (PanelName& panel : plan.panels) panel.inside *= factor;
  return plan;
}

}  // namespace softform
