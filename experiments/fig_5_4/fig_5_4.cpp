// Purpose: a tower danced by five strings (thesis sections 5.4.2, 5.4.3 and 5.6, figure 5.4, and the tower's rows of
// tables 5.1 and 5.2): strings that only pull (5.4), from places on the boundary to pulleys on a ring around the body
// (5.14), the same in five poses.
// Claim: five strings bring the tower within the errors of table 5.1, every pose a stable equilibrium that is reached
// from rest by drawing the strings.

#include <algorithm>

#include <fmt/format.h>

#include "softform/characters/drawing.hpp"
#include "softform/characters/pose_error.hpp"
#include "softform/characters/reachability.hpp"
#include "softform/characters/string_selection.hpp"
#include "softform/experiment/experiment.hpp"
#include "softform/experiment/run.hpp"
#include "softform/materials/registry.hpp"

namespace {

using namespace softform;

constexpr double shear_modulus = 1.6163e5;  // [Pa] of RTV 141 silicone, the fit in datasets/materials/silicone.json
constexpr double thickness = 0.01;          // [m]; it scales the tensions and nothing else
constexpr int string_count = 5;
constexpr double taut = 1e-6;  // [N]

using Edges = Eigen::Matrix<int, Eigen::Dynamic, 2, Eigen::RowMajor>;

PlanarSolid silicone_body(const PlanarMesh& mesh)
{
  SolidOptions<2> options;
  options.thickness = thickness;
  const Mixture silicone(plane_stress(make_material("neo_hookean", {{"mu", shear_modulus}})));
  return PlanarSolid(mesh.elements, mesh.positions, silicone, options);
}

// The tower stands: the soles of its feet are clamped.
FixedDofs soles(const PlanarMesh& mesh)
{
  FixedDofs held{Vec::Ones(mesh.positions.size())};
  for (int i = 0; i < mesh.vertex_count(); ++i)
    if (mesh.positions[2 * i + 1] < 1e-9) held.free.segment<2>(2 * i).setZero();
  return held;
}

// x with its clamped coordinates where `clamped` has them.
Vec with_clamps(const FixedDofs& held, const Vec& x, const Vec& clamped)
{
  return held.free.cwiseProduct(x) + (1 - held.free.array()).matrix().cwiseProduct(clamped);
}

void write_points(Run& run, const std::string& name, const Vec& x)
{
  CsvTable& points = run.series(name, {{"x", "m"}, {"y", "m"}});
  for (Eigen::Index i = 0; i < x.size(); i += 2) points.add_row({x[i], x[i + 1]});
}

void write_mesh(Run& run, const PosedCharacter& tower, const Edges& edges)
{
  CsvTable& triangles = run.series("triangles", {{"a", "1"}, {"b", "1"}, {"c", "1"}});
  for (const auto& t : tower.rest.elements.rowwise()) triangles.add_row({double(t[0]), double(t[1]), double(t[2])});
  CsvTable& outline = run.series("outline", {{"a", "1"}, {"b", "1"}});
  for (const auto& e : edges.rowwise()) outline.add_row({double(e[0]), double(e[1])});
  write_points(run, "rest", tower.rest.positions);
  for (std::size_t i = 0; i < tower.names.size(); ++i) write_points(run, "target_" + tower.names[i], tower.targets[i]);
}

// Returns the mean over the poses of the mean errors.
double write_errors(Run& run, const std::vector<std::string>& names, const std::string& stage, const PosedBody& posed,
                    const StringPoses& poses)
{
  double mean = 0;
  for (std::size_t i = 0; i < posed.pose_count(); ++i) {
    const PoseError error = pose_error<2>(poses.positions[i], posed.targets[i]);
    mean += error.mean / static_cast<double>(posed.pose_count());
    run.metric(fmt::format("max_error_{}_{}", stage, names[i]), error.max, "m");
    run.metric(fmt::format("mean_error_{}_{}", stage, names[i]), error.mean, "m");
  }
  return mean;
}

using Segment = std::pair<Point<2>, Point<2>>;

// The strings of a pose, from the body to the ring.
std::vector<Segment> segments(const BoundaryField& field, const StringPlacement& placement, std::size_t pose)
{
  const Vec& x = placement.poses.positions[pose];
  std::vector<Segment> lines;
  for (const String<2>& string : strings_of_pose(field, placement.strings, pose)) {
    Point<2> tied = Point<2>::Zero();
    for (std::size_t k = 0; k < string.point.vertices.size(); ++k)
      tied += string.point.weights[k] * x.segment<2>(2 * string.point.vertices[k]);
    lines.emplace_back(tied, string.anchor);
  }
  return lines;
}

bool cross(const Segment& a, const Segment& b)
{
  const auto side = [](const Segment& line, const Point<2>& at) {
    const Point<2> along = line.second - line.first, to = at - line.first;
    return along.x() * to.y() - along.y() * to.x() > 0;
  };
  return side(a, b.first) != side(a, b.second) && side(b, a.first) != side(b, a.second);
}

// What is built: the ring, where strings are tied, where they leave the ring; by pose where their ends are, their
// tension and free length.
void write_plan(Run& run, const std::vector<std::string>& names, const StringPlan& plan,
                const StringPlacement& placement, const BoundaryField& field)
{
  run.series("ring", {{"x", "m"}, {"y", "m"}, {"radius", "m"}})
      .add_row({plan.ring_centre.x(), plan.ring_centre.y(), plan.ring_radius});
  CsvTable& strings = run.series("strings", {{"place_x", "m"}, {"place_y", "m"}, {"ring_x", "m"}, {"ring_y", "m"}});
  for (const StringPlan::Line& line : plan.strings)
    strings.add_row({line.place.x(), line.place.y(), line.ring_point.x(), line.ring_point.y()});
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::vector<Segment> lines = segments(field, placement, i);
    CsvTable& table = run.series("strings_" + names[i], {{"x", "m"}, {"y", "m"}, {"tension", "N"}, {"length", "m"}});
    for (std::size_t j = 0; j < lines.size(); ++j)
      table.add_row(
          {lines[j].first.x(), lines[j].first.y(), plan.strings[j].tensions[i], plan.strings[j].free_lengths[i]});
  }
}

// How hard strings are drawn, how much of them lies in the body, and which taut ones cross each other.
void check_strings(Run& run, const PosedBody& posed, const Edges& edges, const StringPlacement& placement,
                   const BoundaryField& field)
{
  double least = HUGE_VAL, largest = 0, longest = 0;
  int taut_strings = 0, taut_in_body = 0, in_body = 0, crossing_pairs = 0;
  for (std::size_t i = 0; i < posed.pose_count(); ++i) {
    const std::vector<Segment> lines = segments(field, placement, i);
    const Vec& tensions = placement.strings.tensions[i];
    const auto is_taut = [&](std::size_t j) { return tensions[static_cast<Eigen::Index>(j)] > taut; };
    least = std::min(least, tensions.minCoeff());
    largest = std::max(largest, tensions.maxCoeff());
    for (std::size_t a = 0; a < lines.size(); ++a) {
      const double inside = length_inside(edges, placement.poses.positions[i], lines[a].first, lines[a].second);
      in_body += inside > field.radius() / 4 ? 1 : 0;
      if (!is_taut(a)) continue;
      ++taut_strings;
      taut_in_body += inside > field.radius() / 4 ? 1 : 0;
      longest = std::max(longest, inside);
      for (std::size_t b = 0; b < a; ++b) crossing_pairs += is_taut(b) && cross(lines[a], lines[b]) ? 1 : 0;
    }
  }
  run.metric("least_tension", least, "N");
  run.metric("largest_tension", largest, "N");
  run.metric("taut_strings", taut_strings, "1");
  run.metric("taut_strings_in_body", taut_in_body, "1");
  run.metric("longest_in_body", longest, "m");
  run.metric("strings_in_body", in_body, "1");
  run.metric("crossing_pairs", crossing_pairs, "1");
}

// The pose of strings that are drawn while the feet step from where they are at rest to `feet`.
PoseTrace drawn(const PosedBody& posed, const StringLayout& strings, std::size_t pose, const Vec& feet)
{
  const BoundaryField field(posed.body);
  const Vec& rest = posed.body.rest_positions();
  const auto loads = [&](double share) {
    std::vector<String<2>> lines = strings_of_pose(field, strings, pose);
    for (String<2>& line : lines) line.tension *= share;
    return LoadedSolid<2>(posed.body, posed.densities, {}, {}, std::move(lines));
  };
  const auto steps = [&](double share) -> Vec { return rest + share * (feet - rest); };
  return trace_pose<2>(LoadPath<2>(loads), posed.held, steps);
}

// Every pose from rest.
void trace_from_rest(Run& run, const std::vector<std::string>& names, const PosedBody& posed,
                     const StringPlacement& placement)
{
  for (std::size_t i = 0; i < names.size(); ++i) {
    const PoseTrace trace = drawn(posed, placement.strings, i, posed.targets[i]);
    run.metric("reached_" + names[i], trace.is_reached ? 1 : 0, "1");
    run.metric("trace_difference_" + names[i], (trace.x - placement.poses.positions[i]).lpNorm<Eigen::Infinity>(), "m");
    double least = HUGE_VAL;
    for (const TraceStep& step : trace.steps) least = std::min(least, step.relative_eigenvalue);
    run.metric("least_relative_eigenvalue_" + names[i], least, "1");
  }
}

// Feet that stay where they are at rest in every pose: placed again from the poses that the same strings then give.
void keep_feet_at_rest(Run& run, const std::vector<std::string>& names, const PosedBody& posed,
                       const StringPlacement& placement)
{
  std::vector<Vec> start;
  for (std::size_t i = 0; i < names.size(); ++i)
    start.push_back(with_clamps(posed.held, drawn(posed, placement.strings, i, posed.body.rest_positions()).x,
                                posed.body.rest_positions()));
  write_errors(run, names, "feet_at_rest", posed, place_strings(posed, placement.strings, start).poses);
}

// How the error falls with the number of strings.
void count_strings(Run& run, const PosedBody& posed, const Ring& ring)
{
  CsvTable& table = run.series("counts", {{"strings", "1"}, {"mean_error", "m"}, {"max_error", "m"}});
  for (const int count : {3, 4, 5, 6, 7, 9, 12}) {
    run.step(fmt::format("{} strings", count));
    const StringSelection selection = select_strings(posed, ring, count);
    const StringPoses poses = place_strings(posed, selection.strings, selection.poses.positions).poses;
    double mean = 0, max = 0;
    for (std::size_t i = 0; i < posed.pose_count(); ++i) {
      const PoseError error = pose_error<2>(poses.positions[i], posed.targets[i]);
      mean += error.mean / static_cast<double>(posed.pose_count());
      max = std::max(max, error.max);
    }
    table.add_row({double(count), mean, max});
  }
}

void dance(Run& run)
{
  // 1. The tower, its poses, and a ring around them all.
  const PosedCharacter tower = make_character(load_drawing("tour_eiffel"), run.by_size(300, 525));
  const std::vector<std::string>& names = tower.names;
  const PlanarSolid body = silicone_body(tower.rest);
  const PosedBody posed{body, Vec::Zero(body.element_count()), soles(tower.rest), tower.targets};
  std::vector<Vec> all = tower.targets;
  all.push_back(tower.rest.positions);
  const Ring ring = ring_around(all);
  const Edges edges = boundary_faces<2>(tower.rest.elements).faces;
  write_mesh(run, tower, edges);
  run.metric("elements", body.element_count(), "1");

  // 2. Which strings, then where they are tied, where they leave the ring, and how hard they are drawn.
  StringSelection selection;
  StringPlacement placement;
  run.time("layout", [&] {
    run.time("stage_1", [&] { selection = select_strings(posed, ring, string_count); });
    run.time("stage_2", [&] { placement = place_strings(posed, selection.strings, selection.poses.positions); });
  });
  const double first = write_errors(run, names, "1", posed, selection.poses);
  const double second = write_errors(run, names, "2", posed, placement.poses);
  run.metric("mean_2_over_1", second / first, "1");
  run.metric("candidates", selection.candidates, "1");
  run.metric("iterations", placement.iterations, "1");
  run.metric("failed_equilibria", placement.failed_equilibria, "1");
  run.metric("negative_eigenvalues", selection.poses.negative_eigenvalues + placement.poses.negative_eigenvalues, "1");
  run.metric("residual", std::max(selection.poses.residual, placement.poses.residual), "1");
  const BoundaryField field(body);
  write_plan(run, names, string_plan(field, placement.strings, placement.poses.positions), placement, field);
  check_strings(run, posed, edges, placement, field);
  for (std::size_t i = 0; i < names.size(); ++i) write_points(run, "pose_" + names[i], placement.poses.positions[i]);

  // 3. Each pose from rest.
  run.step("from rest");
  trace_from_rest(run, names, posed, placement);

  // 4. The same with the feet at rest, and with other numbers of strings.
  if (!run.is_paper()) return;
  run.step("feet at rest");
  keep_feet_at_rest(run, names, posed, placement);
  count_strings(run, posed, ring);
}

}  // namespace

int main(int argc, char** argv)
{
  return softform::run_experiment(
      argc, argv, {"fig_5_4", "5.4.3", "Five strings that only pull bring a tower to five poses.", {0.2, 1}}, dance);
}
