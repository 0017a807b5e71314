#include "softform/fitting/shape_fit.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <Eigen/Cholesky>
#include <fmt/format.h>

#include "softform/core/error.hpp"
#include "softform/core/parallel.hpp"
#include "softform/fitting/shape_fit_internal.hpp"
#include "softform/materials/registry.hpp"
#include "softform/mesh/disc.hpp"
#include "softform/optimizers/reduced_gauss_newton.hpp"

namespace softform {

std::vector<ShapeStep> shape_steps(const std::vector<MembraneSample>& samples, double radius, const RbfOptions& options)
{
  const Positions edge = rim(radius);
  if (samples.empty()) throw InputError("no samples to fit to: give one or more");
  std::vector<ShapeStep> steps;
  for (const LoadingStep& step : samples.front().steps) steps.push_back({step.volume, {}});
  for (const MembraneSample& sample : samples) {
    for (std::size_t i = 0; i < steps.size(); ++i) {
      if (sample.steps.size() != steps.size() || sample.steps[i].volume != steps[i].volume)
        throw InputError("samples inflated to different volumes: fit those of the same steps together");
      const Vec3 inside = Vec3::Zero();  // the middle of the opening sees every part of the sheet
      steps[i].observations.push_back({sample.thickness, sample.steps[i].pressure,
                                       std::make_shared<RbfImplicit>(sample.steps[i].scan, inside, options, edge)});
    }
  }
  return steps;
}

namespace {

// A fit has converged when another step promises to lower the objective by less than this share of itself.
constexpr double stationary_below = 1e-5;

std::vector<double> parameter_values(const Material& material)
{
  std::vector<double> values;
  for (const MaterialParameter& parameter : material.parameters()) values.push_back(parameter.value);
  return values;
}

// The decrease that one more Gauss-Newton step promises, as a share of the objective f. With H + f I in place of H a
// parameter of no influence moves by a factor of e or so, not by thousands of them.
double promised_decrease(const NonlinearProgram& program, const Solution& solution)
{
  Vec g;
  SparseMatrix H;
  program.objective_gradient(solution.z, g);
  program.gauss_newton_hessian(solution.z, H);
  Eigen::MatrixXd A = H;
  A.diagonal().array() += solution.objective;
  return 0.5 * g.dot(A.ldlt().solve(g)) / solution.objective;
}

// The gradient alone decides whether this is a minimum: there the optimiser may find no decrease above round-off and
// call it stalled, and in a narrow valley it may take slow progress for an end.
Solution minimize(const ShapeFit& fit, const IterationObserver& observer)
{
  const StopCriteria stop{.max_iterations = 100, .max_time_s = 600, .relative_decrease = 1e-6, .patience = 2};
  const auto program = reduced_program(fit);
  Solution solution = ReducedGaussNewton().minimize(*program, stop, observer);
  Report& report = solution.report;
  if (report.termination == Termination::Infeasible) return solution;
  const double decrease = promised_decrease(*program, solution);
  report.message += fmt::format("; one more step promises to lower it by {:.1e} of itself", decrease);
  if (decrease <= stationary_below)
    report.termination = Termination::Converged;
  else if (report.converged())
    report.termination = Termination::Stalled;
  return solution;
}

bool is_better(const Solution& a, const Solution& b)
{
  return std::pair(!a.report.converged(), a.objective) < std::pair(!b.report.converged(), b.objective);
}

}  // namespace

ShapeFitResult fit_shape(const ShapeFit& fit, const std::vector<std::vector<double>>& other_starts,
                         const IterationObserver& observer)
{
  Solution coarse = minimize(fit, observer);
  for (const std::vector<double>& start : other_starts) {
    ShapeFit other = fit;
    other.start = start;
    Solution solution = minimize(other, observer);
    if (is_better(solution, coarse)) coarse = std::move(solution);
  }
  ShapeFitResult result;
  result.report = coarse.report;
  result.parameters.assign(fit.start.size(), NAN);
  result.coarse = result.fine = result.parameters;
  if (!coarse.report.converged()) return result;
  result.coarse = parameter_values(*fitted_material(fit, coarse.z));

  ShapeFit finer = fit;
  finer.rings = 2 * fit.rings;
  finer.start = result.coarse;
  const Solution fine = minimize(finer, observer);
  result.report = fine.report;
  if (!fine.report.converged()) return result;
  result.objective = fine.objective;
  result.fine = parameter_values(*fitted_material(fit, fine.z));
  result.parameters = parameter_values(*fitted_material(fit, (4 * fine.z - coarse.z) / 3));
  return result;
}

std::shared_ptr<const Material> material_of(const ShapeFit& fit, const std::vector<double>& parameters)
{
  const auto expected = expected_parameters(find_material_model(fit.model), parameters.size());
  std::map<std::string, double> by_name;
  for (std::size_t k = 0; k < parameters.size(); ++k) by_name[expected[k].name] = parameters[k];
  return make_material(fit.model, by_name);
}

std::shared_ptr<const Material> fitted_material(const ShapeFit& fit, ConstVec z)
{
  const auto logarithms = z.tail(static_cast<Eigen::Index>(fit.start.size()));
  std::vector<double> parameters;
  for (std::size_t k = 0; k < fit.start.size(); ++k)
    parameters.push_back(std::copysign(std::exp(logarithms[static_cast<Eigen::Index>(k)]), fit.start[k]));
  return material_of(fit, parameters);
}

Vec log_magnitudes(const std::vector<double>& parameters)
{
  return Vec::Map(parameters.data(), static_cast<Eigen::Index>(parameters.size())).array().abs().log();
}

int observation_count(const ShapeFit& fit)
{
  int count = 0;
  for (const ShapeStep& step : fit.steps) count += static_cast<int>(step.observations.size());
  return count;
}

std::vector<double> faceted_volumes(const ShapeFit& fit, const ClampedSheet& sheet)
{
  std::vector<double> found;
  for (const ShapeStep& step : fit.steps) found.push_back(faceted_volume(sheet, step.volume));
  return found;
}

void check(const ShapeFit& fit)
{
  if (fit.steps.empty()) throw InputError("a shape fit without steps: give one or more");
  for (std::size_t i = 0; i < fit.steps.size(); ++i)
    if (!(fit.steps[i].volume > (i == 0 ? 0 : fit.steps[i - 1].volume)) || fit.steps[i].observations.empty())
      throw InputError(fmt::format("step {} of the shape fit: volumes must rise, and each needs an observation", i));
  const auto expected = expected_parameters(find_material_model(fit.model), fit.start.size());
  if (expected.size() != fit.start.size())
    throw InputError(fmt::format("{} has {} parameters, the start {}", fit.model, expected.size(), fit.start.size()));
  for (std::size_t k = 0; k < fit.start.size(); ++k)
    if (fit.start[k] == 0 || !std::isfinite(fit.start[k]))
      throw InputError(
          fmt::format("{} starts at {}: give a finite value other than 0", expected[k].name, fit.start[k]));
  if (!(fit.distance_scale > 0) || !(fit.pressure_scale > 0))
    throw InputError("the scales of distance and pressure must be positive");
}

StepMisfit step_misfit(const ShapeFit& fit, const ShapeStep& step, ConstVec x, double pressure)
{
  const int free = disc_vertex_count(fit.rings - 1);
  StepMisfit misfit{0, Vec::Zero(3 * free), std::vector<Eigen::Matrix3d>(static_cast<std::size_t>(free)), 0, 0};
  for (Eigen::Matrix3d& block : misfit.hessian) block.setZero();
  Vec values = Vec::Zero(free);
  const double weight = 1 / (free * fit.distance_scale * fit.distance_scale);
  for (const ShapeObservation& observation : step.observations) {
    parallel_for(free, [&](int i) {
      Vec3 gradient;
      const double distance = observation.surface->value(vertex(x, i), gradient);
      values[i] += weight / 2 * distance * distance;
      misfit.gradient.segment<3>(3 * i) += weight * distance * gradient;
      misfit.hessian[static_cast<std::size_t>(i)] += weight * gradient * gradient.transpose();
    });
    if (fit.control == Control::Pressure) continue;
    const double factor = observation.thickness / (reference_thickness * fit.pressure_scale);
    const double excess = factor * pressure - observation.pressure / fit.pressure_scale;
    misfit.value += 0.5 * excess * excess;
    misfit.pressure_gradient += excess * factor;
    misfit.pressure_hessian += factor * factor;
  }
  misfit.value += values.sum();
  return misfit;
}

}  // namespace softform
