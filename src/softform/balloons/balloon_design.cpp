#include "softform/balloons/balloon_design.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "softform/balloons/nozzle_smoothing.hpp"
#include "softform/core/error.hpp"
#include "softform/core/interrupt.hpp"
#include "softform/core/stopwatch.hpp"
#include "softform/mesh/alignment.hpp"
#include "softform/mesh/distance.hpp"
#include "softform/mesh/self_intersections.hpp"
#include "softform/objectives/collision_penalty.hpp"
#include "softform/objectives/edge_dihedral.hpp"
#include "softform/objectives/vertex_distance.hpp"
#include "softform/objectives/volume_reward.hpp"
#include "softform/optimizers/reduced_gauss_newton.hpp"

namespace softform {
namespace {

void require_positive(double value, const char* name)
{
  if (!(value > 0) || !std::isfinite(value))
    throw InputError(fmt::format("{} is {}: it must be positive", name, value));
}

void validate(const BalloonOptions& options, int vertex_count)
{
  require_positive(options.thickness, "the thickness");
  require_positive(options.rest_scale, "the rest scale");
  if (options.rest_scale >= 1)
    throw InputError(
        fmt::format("the rest scale is {}: a balloon must be smaller at rest than inflated", options.rest_scale));
  if (options.start && (options.start->rest.rows() != vertex_count || options.start->inflated.rows() != vertex_count))
    throw InputError(fmt::format("the start has {} vertices at rest and {} inflated: the target has {}",
                                 options.start->rest.rows(), options.start->inflated.rows(), vertex_count));
}

// The target scaled about its centroid.
Vec downscaled_target(const TriangleMesh& target, double scale)
{
  const Eigen::RowVector3d centroid = target.vertices.colwise().mean();
  const Positions scaled = (scale * (target.vertices.rowwise() - centroid)).rowwise() + centroid;
  return flatten(scaled);
}

RestShapeDesign rest_shape_problem(const TriangleMesh& target, const BalloonOptions& options,
                                   std::shared_ptr<const Membrane> membrane, const Vec& rest0,
                                   const Equilibrium& inflated, const FixedDofs& fixed)
{
  const Triangles& triangles = target.triangles;
  const Vec goal = flatten(target.vertices);
  RestShapeDesign design;
  design.membrane = std::move(membrane);
  design.pressure = inflated.pressure;
  design.force_scale = inflated.pressure * surface_area(goal, triangles) / target.vertex_count();
  design.x0 = inflated.x;
  design.rest_positions0 = rest0;
  design.newton = options.inflation.newton;
  design.fixed = fixed;
  design.is_admissible = [triangles](ConstVec rest) {
    return rest.allFinite() && count_self_intersections({unflatten(rest), triangles}) == 0;
  };

  design.state_terms.push_back(
      {1, std::make_shared<EdgeDihedralDistance>(triangles, goal,
                                                 EdgeDihedralWeights{options.stretch_weight, options.bending_weight})});
  if (options.vertex_distance_weight > 0)
    design.state_terms.push_back(
        {options.vertex_distance_weight, std::make_shared<AlignedVertexDistance>(triangles, goal)});

  const double edge = mean_edge_length({unflatten(rest0), triangles});
  design.design_terms = {{options.rest_bending_weight,
                          std::make_shared<EdgeDihedralDistance>(triangles, rest0, EdgeDihedralWeights{0, 1})},
                         {options.rest_volume_weight, std::make_shared<VolumeReward>(triangles, rest0)},
                         {options.collision_weight,
                          std::make_shared<CollisionPenalty>(triangles, rest0, options.collision_threshold * edge,
                                                             options.collision_geodesic * edge)}};
  return design;
}

bool report_phase(const BalloonObserver& observer, const char* phase, const Iterate* iterate = nullptr)
{
  return !observer || observer({phase, iterate});
}

// Scales rest shape and state z = (x, X) until the target's volume is enclosed: with h fixed, W(s x, s X) = s^2 W(x, X)
// and V(s x) = s^3 V(x), so that the forces stay in balance at the pressure p / s. Returns the scaled state.
Vec sized_to_target(const TriangleMesh& target, const Vec& z, PressurizedMembrane& balloon, BalloonDesign& result)
{
  const Vec x = z.head(z.size() / 2), rest = z.tail(z.size() / 2);
  const double s = std::cbrt(enclosed_volume(target) / balloon.volume().value(x));
  balloon.set_rest_positions(s * rest);
  result.size_factor = s;
  result.pressure /= s;
  return s * x;
}

// Positions scaled by s about the nozzle's centre, but for those within its radius; in between the scale is blended
// over two radii. This maps space one to one for s near 1, so that no surface comes to cut itself.
Vec scaled_around(const Nozzle& nozzle, const Vec& positions, double s)
{
  Vec scaled = positions;
  for (Eigen::Index i = 0; i < positions.size(); i += 3) {
    const Vec3 offset = positions.segment<3>(i) - nozzle.position;
    const double t = std::clamp((offset.norm() / nozzle.radius - 1) / 2, 0.0, 1.0);
    scaled.segment<3>(i) += (s - 1) * t * t * (3 - 2 * t) * offset;
  }
  return scaled;
}

// The same with a nozzle, which keeps its size: balance is lost near it, and found again at the target's volume.
Vec sized_around_nozzle(const TriangleMesh& target, const Vec& z, const BalloonOptions& options, const FixedDofs& fixed,
                        PressurizedMembrane& balloon, SparseFactorization& factorization, BalloonDesign& result)
{
  const double volume = enclosed_volume(target);
  const Vec x = z.head(z.size() / 2), rest = z.tail(z.size() / 2);
  const double s = std::cbrt(volume / balloon.volume().value(x));
  balloon.set_rest_positions(scaled_around(*result.nozzle, rest, s));
  const Equilibrium sized = solve_at_volume(balloon, volume, scaled_around(*result.nozzle, x, s), result.pressure / s,
                                            factorization, options.inflation.newton, fixed);
  result.size_factor = s;
  result.pressure = sized.pressure;
  if (!sized.report.converged()) result.report = sized.report;
  return sized.x;
}

// Fills in what is known of the equilibrium of the final rest shape.
void check_result(const PressurizedMembrane& balloon, const Vec& x, const FixedDofs& fixed,
                  SparseFactorization& factorization, BalloonDesign& result)
{
  const PressurePotential potential(balloon, result.pressure, x);
  Vec g;
  SparseMatrix K;
  potential.gradient(x, g);
  potential.hessian(x, K);
  fixed.project(g);
  fixed.project(K, K.diagonal().cwiseAbs().mean());
  result.residual = largest_nodal_norm(g) / potential.force_scale();
  result.negative_eigenvalues = count_negative_eigenvalues(std::move(K), factorization);
  result.mean_stretch = balloon.membrane().mean_stretch(x, balloon.rest_positions());
}

// Times and counts for the result what the problem is asked.
void observe(RestShapeDesign& problem, BalloonDesign& result)
{
  problem.is_admissible = [&result, is_admissible = std::move(problem.is_admissible)](ConstVec rest) {
    const Stopwatch watch(result.times.collision);
    return is_admissible(rest);
  };
  problem.on_equilibrium = [&result](const Equilibrium& found) {
    ++result.counts.equilibria;
    result.counts.equilibrium_steps += found.iterations;
  };
}

// `inner_solves`: factorisations made for equilibria rather than for shape steps.
void add_optimization(const Report& report, int inner_solves, BalloonDesign& result)
{
  result.report = report;
  result.counts.shape_steps = report.evaluations.linear_solve - inner_solves;
  result.times.assembly = report.times.assembly;
  result.times.factorization = report.times.factorization;
  result.times.solve = report.times.solve;
  result.times.equilibrium = report.times.restoration - result.times.collision;
}

// The steps of design_balloon().
class Designer {
 public:
  Designer(const TriangleMesh& target, std::shared_ptr<const Material> material, const BalloonOptions& options,
           const BalloonObserver& observer);
  BalloonDesign design();

 private:
  Equilibrium inflate_downscaled();
  Vec optimize(const Equilibrium& inflated);
  void finish(const Vec& z);
  TriangleMesh in_place(const Vec& x) const
  {
    return result_.nozzle ? TriangleMesh{unflatten(x), target_.triangles} : aligned_to(target_, x);
  }

  const TriangleMesh& target_;
  const BalloonOptions& options_;
  const BalloonObserver& observer_;
  std::shared_ptr<const Membrane> membrane_;
  BalloonDesign result_;
  FixedDofs fixed_;
  Vec rest0_;
  std::optional<PressurizedMembrane> balloon_;  // once its rest shape is known
  SparseFactorization factorization_;
};

Designer::Designer(const TriangleMesh& target, std::shared_ptr<const Material> material, const BalloonOptions& options,
                   const BalloonObserver& observer)
    : target_(target),
      options_(options),
      observer_(observer),
      membrane_(std::make_shared<const Membrane>(target.triangles, target.vertex_count(), std::move(material),
                                                 Vec::Constant(target.triangle_count(), options.thickness)))
{
  if (options_.nozzle) {
    result_.nozzle = place_nozzle(target_, *options_.nozzle);
    fixed_ = held_by(*result_.nozzle, target_.vertex_count());
    rest0_ = flatten(rest_shape_with_nozzle(target_, *result_.nozzle, options_.rest_scale).vertices);
  } else {
    rest0_ = downscaled_target(target_, options_.rest_scale);
  }
  balloon_.emplace(*membrane_, rest0_);
}

// Fills in the result's downscaled shape, and its report when there is no such equilibrium.
Equilibrium Designer::inflate_downscaled()
{
  const Stopwatch watch(result_.times.inflation);
  const auto report = [&] { return report_phase(observer_, "inflating the downscaled target"); };
  report();
  Equilibrium inflated = inflate_to_volume(*balloon_, enclosed_volume(target_), factorization_, options_.inflation,
                                           fixed_, [&](const InflationStep&, const Vec&) { return report(); });
  result_.counts.inflation_steps = inflated.iterations;
  result_.pressure = inflated.pressure;
  result_.rest = {unflatten(rest0_), target_.triangles};
  result_.downscaled = result_.inflated = in_place(inflated.x);
  if (!inflated.report.converged()) {
    result_.report = inflated.report;
    if (result_.report.termination != Termination::Interrupted) result_.report.termination = Termination::Infeasible;
    result_.report.message =
        "the downscaled target does not inflate to the target's volume: " + inflated.report.message;
  }
  return inflated;
}

// The optimum z = (x, X).
Vec Designer::optimize(const Equilibrium& inflated)
{
  RestShapeDesign problem = rest_shape_problem(target_, options_, membrane_, rest0_, inflated, fixed_);
  if (options_.start) {
    problem.rest_positions0 = flatten(options_.start->rest);
    problem.x0 = flatten(options_.start->inflated);
  }
  observe(problem, result_);
  // The linearised forces of a step are balanced to 1e-6 with this weight already. With 1e3 the shift against round-off
  // damped the last steps, the more the finer the mesh: at 3265 vertices they converged linearly, now superlinearly.
  const ReducedGaussNewton method({.constraint_weight = 10});
  const auto program = full_space_program(problem);
  Solution solution = method.minimize(*program, options_.stop, [&](const Iterate& iterate) {
    return report_phase(observer_, "optimising the rest shape", &iterate);
  });
  add_optimization(solution.report, program->inner_linear_solves(), result_);
  return std::move(solution.z);
}

// Sizes the optimum and checks it.
void Designer::finish(const Vec& z)
{
  balloon_->set_rest_positions(z.tail(z.size() / 2));
  const Vec x = result_.nozzle ? sized_around_nozzle(target_, z, options_, fixed_, *balloon_, factorization_, result_)
                               : sized_to_target(target_, z, *balloon_, result_);
  result_.rest.vertices = unflatten(balloon_->rest_positions());
  result_.inflated = in_place(x);
  check_result(*balloon_, x, fixed_, factorization_, result_);
}

BalloonDesign Designer::design()
{
  const Equilibrium inflated = inflate_downscaled();
  if (inflated.report.converged()) finish(optimize(inflated));
  return std::move(result_);
}

}  // namespace

TriangleMesh aligned_to(const TriangleMesh& target, ConstVec x)
{
  Positions positions = unflatten(x);
  positions = rigid_alignment(positions, target.vertices)(positions);
  positions = rigid_alignment(positions, SurfaceDistance(target))(positions);
  return {positions, target.triangles};
}

ShapeDistance shape_distance(const TriangleMesh& inflated, const TriangleMesh& target, Vec* each)
{
  const Vec distances = SurfaceDistance(target).distances(inflated.vertices);
  if (each != nullptr) *each = distances;
  return {distances.mean(), distances.maxCoeff()};
}

BalloonDesign design_balloon(const TriangleMesh& target, std::shared_ptr<const Material> material,
                             const BalloonOptions& options, const BalloonObserver& observer)
{
  validate(options, target.vertex_count());
  double total = 0;
  BalloonDesign result = [&] {
    const Stopwatch watch(total);
    return Designer(target, std::move(material), options, observer).design();
  }();
  result.times.total = total;
  return result;
}

}  // namespace softform
