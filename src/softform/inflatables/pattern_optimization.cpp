#include "softform/inflatables/pattern_optimization.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "softform/core/interrupt.hpp"
#include "softform/core/stopwatch.hpp"
#include "softform/optimizers/registry.hpp"

namespace softform {
namespace {

/// The layout in other units of length.
PanelLayout scaled(PanelLayout layout, double factor)
{
  layout.nodes *= factor;
  layout.flat *= factor;
  return layout;
}

InflatedPanels scaled(const InflatedPanels& panels, double factor)
{
  return {scaled(panels.layout, factor), factor * panels.x};
}

/// With lengths in units of `size` and pressures in units of the pressure, energies are in units of p size^3: what is
/// left of material and thickness is their product with the energy density over p size.
InflationSettings in_units_of(double size, InflationSettings inflation)
{
  inflation.thickness /= size;
  return inflation;
}

/// One optimisation across remeshings.
class PatternRun {
 public:
  PatternRun(const InflatedPanels& start, const PatternTarget& target, const InflationSettings& inflation,
             const PatternOptions& options, const PatternObserver& observer)
      : target_(target),
        unit_distance_({target.surface().vertices / target.size(), target.surface().triangles}),
        inflation_(in_units_of(target.size(), inflation)),
        options_(options),
        observer_(observer),
        panels_(scaled(start, 1 / target.size())),
        design_(panels_)
  {}

  PatternOptimum run();

 private:
  std::unique_ptr<Optimizer> method() const;
  void optimize(const InflationSettings& inflation, double tolerance);
  bool optimize_on_mesh();
  bool watch(const FullSpaceProgram& program, Iterate iterate);
  void remesh();

  const PatternTarget& target_;
  SurfaceDistance unit_distance_;
  InflationSettings inflation_;  // of the present optimisation, to `tolerance_`
  double tolerance_ = 0;
  const PatternOptions& options_;
  const PatternObserver& observer_;
  InflatedPanels panels_;  // in units of the target's size, as all else in here
  InflatedPanels design_;  // the last iterate: panels_ just meshed anew are not in equilibrium yet
  PatternOptimum optimum_;
  int iterations_ = 0;
  double elapsed_ = 0;
  double threshold_ = 0;  // of this mesh's quality
  Vec first_areas_;       // of its flat triangles
  bool wants_new_triangles_ = false, was_stopped_ = false;
  bool has_iterate_ = false, is_new_mesh_ = false;  // of this mesh; it was just made
};

bool PatternRun::watch(const FullSpaceProgram& program, Iterate iterate)
{
  if (iterate.z == nullptr) return true;
  panels_.x = program.state(*iterate.z);
  const Vec flat = program.design(*iterate.z);
  panels_.layout.flat = Eigen::Map<const FlatPositions>(flat.data(), panels_.layout.vertex_count(), 2);
  design_ = panels_;
  has_iterate_ = true;
  iterate.k += iterations_;
  iterate.elapsed_s += elapsed_;
  optimum_.report.trace.push_back(iterate);
  optimum_.report.trace.back().z = nullptr;
  if (observer_) {
    const InflatedPanels shown = scaled(panels_, target_.size());
    was_stopped_ = !observer_({shown, iterate, optimum_.remeshings});
  }
  wants_new_triangles_ =
      optimum_.remeshings < options_.max_remeshings &&
      (flat_quality(panels_.layout).minCoeff() < threshold_ ||
       (flat_areas(panels_.layout).array() / first_areas_.array()).maxCoeff() > options_.largest_growth);
  return !was_stopped_ && !wants_new_triangles_;
}

std::unique_ptr<Optimizer> PatternRun::method() const
{
  if (options_.optimizer != "feasible_newton") return make_optimizer(options_.optimizer);
  FeasibleNewtonOptions newton = options_.newton;
  if (!optimum_.report.trace.empty()) newton.damping = std::max(newton.damping, optimum_.report.trace.back().damping);
  return std::make_unique<FeasibleNewton>(newton);
}

/// Returns true when the panels are to be meshed anew.
bool PatternRun::optimize_on_mesh()
{
  // Triangles that are bad from the start, in tips of panels, are no reason to mesh again and again.
  threshold_ = std::min(options_.remeshing.quality_threshold, 0.5 * flat_quality(panels_.layout).minCoeff());
  PatternWeights weights = options_.weights;
  if (options_.optimizer != "feasible_newton") weights.stability = 0;
  const auto program = pattern_program(
      panels_.layout, panels_.x, inflation_, target_.field(),
      {.weights = weights, .laplacian = options_.laplacian, .least_quality = 0.5 * std::max(0.0, threshold_)});
  first_areas_ = flat_areas(panels_.layout);
  wants_new_triangles_ = has_iterate_ = false;
  StopCriteria stop = options_.stop;
  stop.tolerance = tolerance_;
  stop.max_iterations -= iterations_;
  stop.max_time_s -= elapsed_;
  const Solution solution =
      method()->minimize(*program, stop, [&](const Iterate& iterate) { return watch(*program, iterate); });
  if (!has_iterate_ && is_new_mesh_) {
    panels_ = design_;
    is_new_mesh_ = false;
    return optimize_on_mesh();
  }
  Report& report = optimum_.report;
  report.termination = solution.report.termination;
  report.message = solution.report.message;
  iterations_ = report.trace.empty() ? 0 : report.trace.back().k;
  elapsed_ = report.trace.empty() ? 0 : report.trace.back().elapsed_s;
  if (report.termination == Termination::IterationLimit) report.message = fmt::format("{} iterations", iterations_);
  optimum_.residual = report.trace.empty() ? HUGE_VAL : report.trace.back().infeasibility;
  return wants_new_triangles_ && !was_stopped_;
}

/// Panels that cross themselves cannot be meshed anew, and others may find no equilibrium then: in both cases the
/// optimisation goes on with the triangles that there are, until they get worse by half.
void PatternRun::remesh()
{
  ++optimum_.remeshings;
  auto anew = remeshed(panels_.layout, panels_.x, unit_distance_, options_.remeshing);
  is_new_mesh_ = anew.has_value();
  if (anew) panels_ = {std::move(anew->layout), std::move(anew->x)};
}

void PatternRun::optimize(const InflationSettings& inflation, double tolerance)
{
  inflation_ = inflation;
  tolerance_ = tolerance;
  while (optimize_on_mesh()) remesh();
  panels_ = design_;
}

PatternOptimum PatternRun::run()
{
  const InflationSettings inflation = inflation_;
  if (inflation.first_material) {
    InflationSettings first = inflation;
    first.material = inflation.first_material;
    optimize(first, options_.first_tolerance * options_.stop.tolerance);
  }
  if (optimum_.report.termination != Termination::Interrupted) optimize(inflation, options_.stop.tolerance);
  optimum_.panels = scaled(design_, target_.size());
  return std::move(optimum_);
}

}  // namespace

PatternTarget::PatternTarget(TriangleMesh surface)
    : surface_(std::move(surface)),
      size_((surface_.vertices.colwise().maxCoeff() - surface_.vertices.colwise().minCoeff()).maxCoeff()),
      field_(std::make_shared<ImlsField>(imls_field({surface_.vertices / size_, surface_.triangles}))),
      distance_(std::make_shared<SurfaceDistance>(surface_))
{}

Equilibrium inflate_again(const InflatedPanels& panels, const InflationSettings& inflation)
{
  const Inflatable inflatable(panels.layout, inflation.material, inflation.thickness, inflation.pressure);
  SparseFactorization factorization;
  return inflate(inflatable, flat_vector(panels.layout), panels.x, factorization, inflation.newton);
}

InflatedPanels inflated_panels(PanelLayout layout, const InflationSettings& inflation)
{
  InflatedPanels panels{std::move(layout), {}};
  panels.x = flatten(panels.layout.nodes);
  InflationSettings first = inflation;
  if (first.first_material) first.material = first.first_material;
  panels.x = inflate_again(panels, first).x;
  return panels;
}

PatternOptimum optimize_pattern(const InflatedPanels& start, const PatternTarget& target,
                                const InflationSettings& inflation, const PatternOptions& options,
                                const PatternObserver& observer)
{
  return PatternRun(start, target, inflation, options, observer).run();
}

}  // namespace softform
