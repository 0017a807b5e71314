#include "softform/characters/character_file.hpp"

#include <algorithm>
#include <map>

#include "softform/characters/character_file_internal.hpp"
#include "softform/core/units.hpp"
#include "softform/io/text_file.hpp"

namespace softform {

const char* const character_file_help =
    R"(CONFIG is JSON. Values in quotes carry their unit; plain coordinates are in the file's "unit".
  {
    "comment": "...",                              optional
    "unit": "mm",                                  of plain coordinates, here and in meshes [mm]
    "body":                                        one of three:
      {"drawing": "palmy_2d.json",                 a planar character, meshed with this many triangles, and its poses
       "triangles": 2745, "thickness": "10mm",     or some of them; datasets/characters/README.md explains drawings
       "poses": ["wind", "cheer"]}
      {"bar": [80, 4, 6], "cells": [42, 6, 3],     a bar along x, bent about z: between two places along x, by degrees
       "poses": [{"name": "hook", "bends": [[5, 46, -220], [48, 64, 50]]}]}
      {"mesh": "body.obj",                         a mesh, and poses with the same vertices and elements, moved:
       "poses": [{"name": "a", "file": "a.obj"}],  triangles in z = 0 with a "thickness": OBJ, OFF, PLY, VTU;
       "thickness": "10mm"}                        tetrahedra: VTU; closed surfaces: OBJ, OFF, PLY, filled by TetGen with
                                                   about so many "tetrahedra" (as few as it likes)
    "materials": {
      "soft": {"shear_modulus": "160kPa", "density": "1070kg/m^3"},    density optional [0: no weight]
      "stiff": {"shear_modulus": "160MPa"},        not softer than soft; leave it out for one material
      "poisson_ratio": 0.4},                       of solids [0.4]; planar bodies are incompressible sheets
    "gravity": ["0m/s^2", "-9.81m/s^2"],           optional, one value a coordinate [no gravity]
    "actuators":                                   one of three kinds; pins and strings need a planar body:
      {"kind": "pins", "count": [4, 6],            how many, from ... to; or "vertices": [3, 17], numbers in the mesh
       "clamps": {"foot": [[-5, 0], [5, 2]]}}      held at rest: boxes by two corners; optional
      {"kind": "strings", "count": [4, 6],         pulled over a ring around the body, "ring" times as large as the
       "ring": 1.2, "clamps": {...}}               poses [1.2]; something must be held. As many as may be are used
      {"kind": "clamps",                           moved as the poses move what is in their boxes, rigidly
       "clamps": {"left": [[0, 0, 0], [4, 4, 6]], "right": [[76, 0, 0], [80, 4, 6]]}}
    "stages": ["actuators", "places", "materials"],  optional: leave out the last ones. Strings have no "materials",
                                                   with clamps they are ["uniform", "materials"]
    "weights": {"smooth": 0.2, "soft": 1e-4, "crisp": 4e-3,            of (5.18), (5.19), (5.17) at the start
                "boundary": 10, "repulsion": 0.01},                    of (5.11), (5.13); all optional
    "first_density": 0.5,                          of the uniform body that the layout starts from [0.5]
    "print": {"smallest": "1mm",                   what is narrower is reported as too small [1mm]
              "gap": "10um",                       between parts that touch in an edge or a point only [10um]
              "pin_diameter": "2mm", "margin": "15mm"}                 of the plate's holes; around them
  })";

namespace {

using Json = nlohmann::json;
using Entry = JsonEntry;
using character_file::list_of;
using character_file::positive;
using character_file::read_body;

class TaskReader {
 public:
  explicit TaskReader(const std::filesystem::path& file) : folder_(file.parent_path()) { task_.source = file.string(); }

  CharacterTask read(const Json& json);

 private:
  void read_materials(const Entry& materials);
  void read_gravity(const Entry& gravity);
  void read_actuators(const Entry& actuators);
  void read_clamps(const Entry& actuators);
  Clamp clamp_from(const Entry& box, const std::string& name) const;
  void read_count(const Entry& actuators);
  void read_vertices(const Entry& actuators);
  void read_stages(const Entry* stages);
  void read_weights(const Entry& weights);
  void read_print(const Entry& print);
  int dimension() const { return task_.is_planar() ? 2 : 3; }
  const Vec& rest() const
  {
    return std::visit([](const auto& body) -> const Vec& { return body.rest.positions; }, task_.body);
  }
  FixedDofs& held()
  {
    return std::visit([](auto& body) -> FixedDofs& { return body.held; }, task_.body);
  }
  std::vector<int> boundary() const
  {
    return task_.is_planar() ? boundary_vertices<2>(std::get<0>(task_.body).rest.elements)
                             : boundary_vertices<3>(std::get<1>(task_.body).rest.elements);
  }
  bool is_held(int vertex)
  {
    const Vec& free = held().free;
    return free.size() > 0 && free[Eigen::Index(dimension()) * vertex] == 0;
  }

  std::filesystem::path folder_;
  double unit_ = 1e-3;
  CharacterTask task_;
};

CharacterTask TaskReader::read(const Json& json)
{
  const Entry file{json, task_.source};
  file.require_keys({"body", "materials", "actuators"},
                    {"comment", "unit", "gravity", "stages", "weights", "first_density", "print"});
  if (file.has("unit"))
    unit_ = Entry{Json(fmt::format("1{}", file.at("unit").text())), file.at("unit").place}.quantity(parse_length);
  // What costs nothing first: reading a body may fill a surface with tetrahedra.
  read_materials(file.at("materials"));
  if (file.has("weights")) read_weights(file.at("weights"));
  if (file.has("print")) read_print(file.at("print"));
  task_.body = read_body(file.at("body"), folder_, unit_, task_.print.thickness);
  if (file.at("materials").has("poisson_ratio") && task_.is_planar())
    file.at("materials").at("poisson_ratio").refuse("a planar body is an incompressible sheet: leave it out");
  if (file.has("gravity")) read_gravity(file.at("gravity"));
  read_actuators(file.at("actuators"));
  if (file.has("stages")) {
    const Entry stages = file.at("stages");
    read_stages(&stages);
  } else {
    read_stages(nullptr);
  }
  if (file.has("first_density")) {
    task_.first_density = positive(file.at("first_density"));
    if (task_.first_density >= 1) file.at("first_density").refuse("it lies between 0, soft, and 1, stiff");
  }
  return std::move(task_);
}

void TaskReader::read_materials(const Entry& materials)
{
  materials.require_keys({"soft"}, {"stiff", "poisson_ratio", "comment"});
  const auto read = [&](const char* name, double& shear_modulus, double& density) {
    const Entry material = materials.at(name);
    material.require_keys({"shear_modulus"}, {"density", "comment"});
    shear_modulus = positive(material.at("shear_modulus"), parse_pressure);
    if (material.has("density")) density = positive(material.at("density"), parse_density);
  };
  CharacterMaterials& made = task_.materials;
  read("soft", made.soft_shear_modulus, made.soft_density);
  if (materials.has("stiff")) {
    read("stiff", made.stiff_shear_modulus, made.stiff_density);
    if (made.stiff_shear_modulus < made.soft_shear_modulus)
      materials.at("stiff").refuse(
          fmt::format("its shear modulus is {:g} times that of the soft material, which must "
                      "not be the stiffer one: exchange the two",
                      made.stiff_shear_modulus / made.soft_shear_modulus));
  }
  if (materials.has("poisson_ratio")) {
    made.poisson_ratio = positive(materials.at("poisson_ratio"));
    if (made.poisson_ratio > 0.49)
      materials.at("poisson_ratio").refuse("above 0.49 linear tetrahedra lock: give between 0 and 0.49");
  }
}

void TaskReader::read_gravity(const Entry& gravity)
{
  if (!gravity.json.is_array() || static_cast<int>(gravity.json.size()) != dimension())
    gravity.refuse(fmt::format("{} is not a list of {} accelerations", gravity.json.dump(), dimension()));
  for (std::size_t k = 0; k < gravity.json.size(); ++k)
    task_.gravity[Eigen::Index(k)] = Entry{gravity.json[k], gravity.place}.quantity(parse_acceleration);
  if (!(task_.materials.soft_density > 0))
    gravity.refuse("the materials have no density: add \"density\" to them, or leave gravity out");
}

void TaskReader::read_actuators(const Entry& actuators)
{
  if (!actuators.json.is_object() || !actuators.has("kind"))
    actuators.refuse("must be an object with the key 'kind': pins, strings or clamps");
  const std::string kind = actuators.at("kind").text();
  if (kind == "clamps") {
    task_.kind = ActuatorKind::Clamps;
    actuators.require_keys({"kind", "clamps"}, {"comment"});
    read_clamps(actuators);
    return;
  }
  if (kind != "pins" && kind != "strings")
    actuators.at("kind").refuse(fmt::format("there is no kind '{}': use pins, strings or clamps", kind));
  task_.kind = kind == "pins" ? ActuatorKind::Pins : ActuatorKind::Strings;
  actuators.require_keys({"kind"}, task_.kind == ActuatorKind::Pins
                                       ? std::vector<std::string>{"count", "vertices", "clamps", "comment"}
                                       : std::vector<std::string>{"count", "clamps", "ring", "comment"});
  if (!task_.is_planar())
    actuators.at("kind").refuse(kind + " need a planar body: give the body a thickness, or hold it by clamps");
  if (actuators.has("clamps")) read_clamps(actuators);
  if (actuators.has("count") == actuators.has("vertices"))
    actuators.refuse("give either 'count', how many there may be, or, for pins, 'vertices', where they are");
  if (actuators.has("ring")) {
    task_.ring_margin = positive(actuators.at("ring"));
    if (task_.ring_margin <= 1) actuators.at("ring").refuse("the ring must lie around the body: give more than 1");
  }
  if (actuators.has("count"))
    read_count(actuators);
  else
    read_vertices(actuators);
  if (task_.kind == ActuatorKind::Strings && held().free.size() == 0)
    actuators.refuse("strings only pull: a part of the body must be held; add \"clamps\"");
}

Clamp TaskReader::clamp_from(const Entry& box, const std::string& name) const
{
  const auto d = static_cast<std::size_t>(dimension());
  if (!box.json.is_array() || box.json.size() != 2)
    box.refuse(box.json.dump() + " is not a box: write two opposite corners");
  Vec lower(dimension()), upper(dimension());
  for (std::size_t k = 0; k < 2; ++k) {
    const Entry corner{box.json[k], box.place};
    if (!corner.json.is_array() || corner.json.size() != d)
      corner.refuse(fmt::format("{} is not a corner of {} coordinates", corner.json.dump(), d));
    for (std::size_t a = 0; a < d; ++a)
      (k == 0 ? lower : upper)[Eigen::Index(a)] = unit_ * Entry{corner.json[a], box.place}.number();
  }
  const Vec low = lower.cwiseMin(upper), high = lower.cwiseMax(upper);
  const double slack = 1e-9 * (rest().maxCoeff() - rest().minCoeff());
  Clamp clamp{name, {}};
  for (Eigen::Index i = 0; i < rest().size() / dimension(); ++i) {
    const Vec X = rest().segment(dimension() * i, dimension());
    if ((X.array() >= low.array() - slack).all() && (X.array() <= high.array() + slack).all())
      clamp.vertices.push_back(static_cast<int>(i));
  }
  if (clamp.vertices.size() < 3)
    box.refuse(fmt::format("holds {} vertices: a clamp needs three at least; make it larger", clamp.vertices.size()));
  return clamp;
}

void TaskReader::read_clamps(const Entry& actuators)
{
  const Entry clamps = actuators.at("clamps");
  if (!clamps.json.is_object() || clamps.json.empty())
    clamps.refuse("must be an object of named boxes, {\"foot\": [[x, y], [x, y]]}");
  std::map<int, std::string> holder;
  for (const auto& [name, box] : clamps.json.items()) {
    Clamp clamp = clamp_from({box, fmt::format("{}, '{}'", clamps.place, name)}, name);
    for (const int i : clamp.vertices) {
      const auto [at, is_new] = holder.try_emplace(i, name);
      if (!is_new)
        clamps.refuse(fmt::format("'{}' and '{}' both hold vertex {}: move them apart", at->second, name, i));
    }
    task_.clamps.push_back(std::move(clamp));
  }
  if (task_.kind == ActuatorKind::Clamps) return;
  FixedDofs& body_held = held();
  if (body_held.free.size() == 0) body_held.free = Vec::Ones(rest().size());
  for (const auto& [vertex, name] : holder)
    body_held.free.segment(Eigen::Index(dimension()) * vertex, dimension()).setZero();
}

void TaskReader::read_count(const Entry& actuators)
{
  const std::vector<Entry> ends = list_of(actuators, "count", 2, "end");
  task_.range = {ends[0].integer(), ends[1].integer()};
  int candidates = 0;
  for (const int i : boundary()) candidates += is_held(i) ? 0 : 1;
  const auto [fewest, most] = task_.range;
  if (fewest > most)
    actuators.at("count").refuse(fmt::format("from {} to {} is empty: exchange the two", fewest, most));
  if (fewest < 2) actuators.at("count").refuse(fmt::format("{} cannot be reached: a pose needs two at least", fewest));
  if (most > candidates)
    actuators.at("count").refuse(
        fmt::format("{} cannot be reached: only {} vertices of the boundary are free", most, candidates));
}

void TaskReader::read_vertices(const Entry& actuators)
{
  const std::vector<int> outer = boundary();
  for (const Entry& entry : actuators.list("vertices", "entry")) {
    const int vertex = entry.integer();
    if (!std::binary_search(outer.begin(), outer.end(), vertex))
      entry.refuse(fmt::format("vertex {} is not on the body's boundary: choose one there", vertex));
    for (const Clamp& clamp : task_.clamps)
      if (std::binary_search(clamp.vertices.begin(), clamp.vertices.end(), vertex))
        entry.refuse(fmt::format("vertex {} is held by the clamp '{}': move one of the two", vertex, clamp.name));
    if (is_held(vertex)) entry.refuse(fmt::format("vertex {} is held by the drawing: choose another one", vertex));
    if (std::count(task_.vertices.begin(), task_.vertices.end(), vertex) > 0)
      entry.refuse(fmt::format("vertex {} is there twice: leave it out once", vertex));
    task_.vertices.push_back(vertex);
  }
  if (task_.vertices.size() < 2) actuators.at("vertices").refuse("a pose needs two actuators at least");
}

void TaskReader::read_stages(const Entry* stages)
{
  std::vector<std::string> known = stage_names(task_.kind);
  const bool has_stiff = task_.materials.stiff_shear_modulus > 0;
  if (stages == nullptr) {
    if (!has_stiff && known.back() == "materials") known.pop_back();
    task_.stages = known;
    return;
  }
  if (!stages->json.is_array() || stages->json.empty()) stages->refuse("must be a list that is not empty");
  for (std::size_t k = 0; k < stages->json.size(); ++k) {
    const std::string name = Entry{stages->json[k], stages->place}.text();
    if (k >= known.size() || name != known[k])
      stages->refuse(
          fmt::format("'{}' is not the next stage: they are {}, in this order; the last ones may be left out", name,
                      fmt::join(known, ", ")));
    task_.stages.push_back(name);
  }
  if (task_.stages.back() == "materials" && !has_stiff)
    stages->refuse("'materials' needs two of them: add \"stiff\" to the materials, or leave the stage out");
}

void TaskReader::read_weights(const Entry& weights)
{
  weights.require_keys({}, {"smooth", "soft", "crisp", "boundary", "repulsion", "comment"});
  const auto read = [&](const char* key, double& value) {
    if (weights.has(key)) value = positive(weights.at(key));
  };
  read("smooth", task_.layout.weights.smooth);
  read("soft", task_.layout.weights.soft);
  read("crisp", task_.layout.weights.crisp);
  read("boundary", task_.placement.boundary);
  read("repulsion", task_.placement.repulsion);
}

void TaskReader::read_print(const Entry& print)
{
  print.require_keys({}, {"smallest", "gap", "pin_diameter", "margin", "comment"});
  const auto read = [&](const char* key, double& value) {
    if (print.has(key)) value = positive(print.at(key), parse_length);
  };
  read("smallest", task_.print.printable_size);
  read("gap", task_.print.contacts.gap);
  read("pin_diameter", task_.drill.hole_diameter);
  read("margin", task_.drill.margin);
}

}  // namespace

CharacterTask read_character_task(const std::filesystem::path& file)
{
  const std::string text = read_text(file);
  try {
    CharacterTask task = TaskReader(file).read(Json::parse(text));
    const bool has_pose = std::visit([](const auto& body) { return !body.targets.empty(); }, task.body);
    if (!has_pose) throw InputError(fmt::format("{}, 'body': has no pose: add one to \"poses\"", file.string()));
    return task;
  } catch (const Json::exception& error) {
    throw InputError(fmt::format("{}: is not valid JSON ({}): correct it there", file.string(), error.what()));
  }
}

}  // namespace softform
