// Purpose: the optimisers of thesis section 3.2, and those that a user would reach for, on the same nonlinear
// programmes with the same stopping rules (3.39):
//     min E(x) + R(p)   subject to   f(x, p) = 0,
// in the full space z = (x, p), or in the design p alone with x(p) from an equilibrium solve. What each returns is
// judged by the equilibrium that is solved for again from there: whether it is stable, how far it moved, its objective.
// Claim: of all methods the reduced Gauss-Newton is first to come within 5 % of the best objective on balloons.

#include <cmath>
#include <memory>
#include <optional>

#include <fmt/format.h>

#include "softform/equilibrium/volume_control.hpp"
#include "softform/experiment/experiment.hpp"
#include "softform/experiment/run.hpp"
#include "softform/fitting/least_squares_as_program.hpp"
#include "softform/fitting/shape_fit.hpp"
#include "softform/fitting/trust.hpp"
#include "softform/inverse/rest_shape_design.hpp"
#include "softform/materials/material_file.hpp"
#include "softform/mesh/shapes.hpp"
#include "softform/objectives/edge_dihedral.hpp"
#include "softform/optimizers/registry.hpp"

namespace {

using namespace softform;

// One problem, as constrained programme in the full space, as unconstrained one in the design, or both.
struct Instance {
  std::string name;
  std::shared_ptr<const NonlinearProgram> full, reduced;
};

// A coarse target for the quick size: three different axes.
TriangleMesh ellipsoid(int vertex_count)
{
  TriangleMesh mesh = irregular_sphere(1, vertex_count);
  mesh.vertices.col(0) *= 1.25;
  mesh.vertices.col(2) *= 0.8;
  return mesh;
}

// 1. A rest shape (chapter 4) from the downscaled target. Without the collision and volume terms, which have no exact
//    Hessian.
Instance balloon(const std::string& name, const TriangleMesh& shape, const std::shared_ptr<const Material>& silicone)
{
  const TriangleMesh target = scale_to_diameter(shape, 0.146);
  const Vec goal = flatten(target.vertices);
  RestShapeDesign design;
  design.membrane = std::make_shared<const Membrane>(target.triangles, target.vertex_count(), silicone,
                                                     Vec::Constant(target.triangle_count(), 3e-4));
  design.rest_positions0 = 0.5 * goal;
  const PressurizedMembrane sheet(*design.membrane, design.rest_positions0);
  SparseFactorization factorization;
  const Equilibrium inflated = inflate_to_volume(sheet, enclosed_volume(target), factorization);
  design.x0 = inflated.x;
  design.pressure = inflated.pressure;
  design.force_scale = inflated.pressure * surface_area(goal, target.triangles) / target.vertex_count();
  design.state_terms = {
      {1, std::make_shared<EdgeDihedralDistance>(target.triangles, goal, EdgeDihedralWeights{1, 0.03})}};
  design.design_terms = {{3e-3, std::make_shared<EdgeDihedralDistance>(target.triangles, design.rest_positions0,
                                                                       EdgeDihedralWeights{0, 1})}};
  return {fmt::format("{}_{}", name, target.vertex_count()), full_space_program(design), reduced_program(design)};
}

// 2. The material of a clamped sheet sought by its inflated shapes (4.9).
Instance clamped_sheet(unsigned seed, const std::shared_ptr<const Material>& silicone)
{
  CampaignOptions campaign;
  campaign.thicknesses = {0.5e-3};
  campaign.samples = 1;
  campaign.volumes = {2e-5, 6e-5, 1e-4};
  campaign.rings = 12;
  campaign.seed = seed;
  ShapeFit fit;
  fit.model = "hart_smith";
  fit.start = {0.3e6, 0.01, 0.5};
  fit.rings = 4;
  fit.steps = shape_steps(simulate_campaign(silicone, campaign), fit.radius, {.centres = 200});
  return {"clamped_sheet", full_space_program(fit), reduced_program(fit)};
}

// 3. A material fitted to Treloar's three tests: least squares without constraints.
Instance rubber_fit(const MaterialModel& model)
{
  const std::vector<RubberTest> tests{load_rubber_test("treloar_1944_uniaxial"),
                                      load_rubber_test("treloar_1944_pure_shear"),
                                      load_rubber_test("treloar_1944_sheet_inflation")};
  auto fit = std::make_shared<StressFit>(model, tests, Weights::Absolute, 2);
  const Vec start = 0.5 * (fit->lower_start() + fit->upper_start());
  return {"rubber_" + model.name, nullptr, least_squares_program(fit, start)};
}

// The programme that a method is given: the constrained one where it takes constraints and there is one.
std::shared_ptr<const NonlinearProgram> programme_for(const OptimizerEntry& method, const Instance& instance)
{
  const bool is_rubber = instance.full == nullptr;
  if (method.needs_residuals && !is_rubber) return nullptr;
  if (method.needs_restoration && is_rubber) return nullptr;
  if (method.takes_constraints && !is_rubber) return instance.full;
  // These want the objective's own Hessian, which the reduced balloon has not.
  if (method.name == "gradient_projection" && !is_rubber) return nullptr;
  return instance.reduced;
}

// Dense methods cost the cube of the variables: a thousand would take minutes a step.
bool is_too_large(const OptimizerEntry& method, const NonlinearProgram& program)
{
  return method.name == "nlopt_slsqp" && program.variable_count() > 400;
}

void report(Run& run, const std::string& name, const NonlinearProgram& program, const Solution& solution)
{
  const Iterate& last = solution.report.trace.back();
  run.trace("trace_" + name, solution.report.trace);
  run.metric("termination_" + name, int(solution.report.termination), "1");
  run.metric("objective_" + name, solution.objective, "1");
  run.metric("infeasibility_" + name, last.infeasibility, "1");
  run.metric("stationarity_" + name, last.stationarity, "1");
  run.metric("linear_solves_" + name, solution.report.evaluations.linear_solve, "1");
  run.metric("gradients_" + name, solution.report.evaluations.gradient, "1");
  run.log(fmt::format("{}: {}: {}", name, to_string(solution.report.termination), solution.report.message));
  if (program.constraint_count() == 0) return;
  // The stable equilibrium at the design that was found.
  const std::optional<Vec> restored = program.restore(solution.z);
  run.metric("has_equilibrium_" + name, restored ? 1 : 0, "1");
  if (!restored) return;
  run.metric("restored_objective_" + name, program.objective(*restored), "1");
  run.metric("restored_moved_" + name, (*restored - solution.z).norm() / solution.z.norm(), "1");
}

void compare(Run& run, const Instance& instance, const StopCriteria& stop)
{
  for (const OptimizerEntry& method : optimizers()) {
    const auto program = programme_for(method, instance);
    if (!program || is_too_large(method, *program)) continue;
    const std::string name = instance.name + "_" + method.name;
    run.step(name);
    Solution solution;
    run.time(name, [&] { solution = method.make()->minimize(*program, stop, run.observer()); });
    report(run, name, *program, solution);
  }
}

void compare_all(Run& run)
{
  const std::shared_ptr<const Material> silicone = load_material("silicone");
  StopCriteria stop;
  stop.max_iterations = run.by_size(60, 500);
  stop.max_time_s = run.by_size(2.0, 60.0);
  stop.relative_decrease = 1e-6;
  if (!run.is_paper()) compare(run, balloon("ellipsoid", ellipsoid(150), silicone), stop);
  for (const int vertex_count : run.is_paper() ? std::vector{1000, 2000, 3265} : std::vector<int>{})
    compare(run, balloon("bumpsphere", bumpsphere(1, vertex_count), silicone), stop);
  compare(run, clamped_sheet(run.seed(), silicone), stop);
  for (const MaterialModel& model : material_models()) compare(run, rubber_fit(model), stop);
}

}  // namespace

int main(int argc, char** argv)
{
  return softform::run_experiment(
      argc, argv, {"sec_3_2", "3.2", "The thesis' optimisers and the alternatives on the same programmes.", {1, 30}},
      compare_all);
}
