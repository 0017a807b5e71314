#include "inflatable_designs.hpp"

#include <chrono>
#include <cmath>
#include <memory>
#include <utility>

#include "softform/core/interrupt.hpp"
#include "softform/inflatables/cut_panels.hpp"
#include "softform/inflatables/flatten.hpp"
#include "softform/inflatables/sheet_material.hpp"
#include "softform/io/datasets.hpp"
#include "softform/io/vtk_io.hpp"
#include "softform/materials/material_file.hpp"
#include "softform/materials/registry.hpp"
#include "softform/mesh/geodesic.hpp"

namespace softform::experiments {
namespace {

// Polyester film of 25 um at 1 kPa, which `softform inflatable` takes by default, on a model of 40 cm.
constexpr double film_thickness = 25e-6, film_pressure = 1e3, model_size = 0.4;

struct Source {
  std::string dataset;
  int target_vertices, mesh_vertices, paper_faces, quick_faces;
};

Source source_of(const std::string& name)
{
  if (name == "sphere") return {"sphere", 3265, 348, 692, 400};
  return {"teddy", 3527, 3527, 2974, 1100};
}

TriangleMesh unit_size(TriangleMesh mesh, double size)
{
  mesh.vertices /= size;
  return mesh;
}

double seconds_since(std::chrono::steady_clock::time_point start)
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

InflatableModel load_inflatable(const Run& run, const std::string& name)
{
  const Source source = source_of(name);
  const TriangleMesh target = load_dataset(source.dataset, source.target_vertices);
  const SeamPlan plan = read_seam_file(default_manifest().parent_path() / "seams" / (name + ".json"));
  // The sphere's mesh is the thesis' own size; the bear is cut finely and meshed anew.
  const TriangleMesh mesh = load_dataset(source.dataset, source.mesh_vertices);
  PanelLayout layout = cut_into_panels(mesh, Geodesics(target), plan);
  const double size = (target.vertices.colwise().maxCoeff() - target.vertices.colwise().minCoeff()).maxCoeff();
  layout.nodes /= size;
  InflatableModel model{name, PatternTarget(unit_size(target, size)), std::move(layout)};
  if (run.is_paper() && mesh.triangle_count() == source.paper_faces) return model;
  flatten_panels(model.layout);
  // Seams are snapped into a finer mesh, where they have room.
  model.layout =
      with_triangles(model.layout, model.target.distance(), run.by_size(source.quick_faces, source.paper_faces));
  return model;
}

namespace {

// Models have size 1 and pressure 1 here.
std::unique_ptr<Material> film()
{
  return make_material("neo_hookean", {{"mu", load_material("mylar")->shear_modulus() / film_pressure}});
}
constexpr double unit_thickness = film_thickness / model_size;

}  // namespace

InflationSettings design_film() { return design_inflation(*film(), unit_thickness, 1, 1); }

InflatableDesign design_inflatable(Run& run, const InflatableModel& model, InflatedPanels start,
                                   const PatternWeights& weights)
{
  const auto begin = std::chrono::steady_clock::now();
  InflatableDesign design;
  design.unoptimised = std::move(start);
  PatternOptions options;
  options.weights = weights;
  options.stop.max_iterations = run.by_size(40, 500);
  auto observer = run.observer();
  design.optimum =
      optimize_pattern(design.unoptimised, model.target, design_film(), options, [&](const PatternProgress& now) {
        design.preview.record(seconds_since(begin), skin_mesh(now.panels.layout, now.panels.x));
        return observer(now.iterate);
      });
  run.log("the optimisation ended: " + design.optimum.report.message);
  return design;
}

InflatableDesign design_inflatable(Run& run, const InflatableModel& model)
{
  PanelLayout layout = model.layout;
  flatten_panels(layout);
  return design_inflatable(run, model, inflated_panels(std::move(layout), design_film()));
}

void report_design(Run& run, const InflatableModel& model, const InflatableDesign& design, const std::string& suffix)
{
  const auto distance = [&](const InflatedPanels& panels) {
    return sampled_distance(skin_mesh(panels.layout, panels.x), model.target.distance());
  };
  const ShapeDistance before = distance(design.unoptimised), after = distance(design.optimum.panels);
  const PatternOptimum& optimum = design.optimum;
  const SeamMismatch mismatch = seam_mismatch(optimum.panels.layout);
  run.metric("unoptimised_mean_distance" + suffix, before.mean, "1");
  run.metric("mean_distance" + suffix, after.mean, "1");
  run.metric("max_distance" + suffix, after.max, "1");
  // The same panels of sheets that wrinkle at once (6.6), without what makes the energy smooth.
  const Equilibrium sheets = inflate_again(optimum.panels, sheet_inflation(*film(), unit_thickness, 1, 1));
  const ShapeDistance predicted = distance({optimum.panels.layout, sheets.x});
  run.metric("relaxed_mean_distance" + suffix, predicted.mean, "1");
  run.metric("relaxed_max_distance" + suffix, predicted.max, "1");
  run.metric("relaxed_residual" + suffix, sheets.residual, "1");
  run.metric("improvement" + suffix, before.mean / after.mean, "1");
  run.metric("seam_mismatch_mean" + suffix, mismatch.mean, "1");
  run.metric("seam_mismatch_max" + suffix, mismatch.max, "1");
  run.metric("smallest_quality" + suffix, flat_quality(optimum.panels.layout).minCoeff(), "1");
  run.metric("max_residual" + suffix, optimum.residual, "1");
  const Iterate last =
      optimum.report.trace.empty() ? Iterate{.k = 0, .stationarity = std::nan("")} : optimum.report.trace.back();
  run.metric("stationarity" + suffix, last.stationarity, "1");
  run.metric("converged" + suffix, optimum.report.converged(), "1");
  run.metric("iterations" + suffix, last.k, "1");
  run.metric("remeshings" + suffix, optimum.remeshings, "1");
  run.trace("trace" + suffix, optimum.report.trace);
}

void write_inflated(const Run& run, const std::string& file, const InflatedPanels& panels, const PatternTarget& target)
{
  const TriangleMesh skin = skin_mesh(panels.layout, panels.x);
  write_vtp(run.path(file), skin,
            {{{"distance [1]", target.distance().distances(skin.vertices)}},
             {{"panel [1]", panel_numbers(panels.layout).head(skin.triangle_count())}}});
}

void write_flat(const Run& run, const std::string& file, const PanelLayout& layout)
{
  write_vtp(run.path(file), panels_side_by_side(layout), {{}, {{"panel [1]", panel_numbers(layout)}}});
}

}  // namespace softform::experiments
