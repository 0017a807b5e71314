#include "softform/fitting/parameter_fit.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <limits>
#include <map>
#include <random>

#include <fmt/format.h>

#include "softform/core/error.hpp"

namespace softform {
namespace {

/// A parameter is at the end of its range when taking it there changes the residuals by less than this fraction.
constexpr double bound_fraction = 1e-6;

/// The largest cosine between residuals and a column of the Jacobian that counts as a right angle.
constexpr double largest_cosine = 1e-4;

/// Uniform in the box, the same on every platform.
Vec draw(const Vec& lower, const Vec& upper, std::mt19937_64& generator)
{
  Vec z(lower.size());
  for (Eigen::Index j = 0; j < z.size(); ++j) {
    const double fraction = double(generator() >> 11) * 0x1p-53;
    z[j] = lower[j] + fraction * (upper[j] - lower[j]);
  }
  return z;
}

std::vector<StressObservation> all_observations(const std::vector<RubberTest>& tests)
{
  std::vector<StressObservation> all;
  for (const RubberTest& test : tests) all.insert(all.end(), test.observations.begin(), test.observations.end());
  return all;
}

/// Residuals of this size on average, in units of the stresses, leave nothing to fit: data from a formula.
constexpr double exact_fit = 1e-6;

double exact_norm(const Vec& residuals) { return exact_fit * std::sqrt(double(residuals.size())); }

bool is_exact(const Vec& residuals) { return residuals.norm() <= exact_norm(residuals); }

bool is_same_minimum(const Vec& a, const Vec& b)
{
  return (is_exact(a) && is_exact(b)) || (a - b).norm() <= 1e-3 * std::min(a.norm(), b.norm());
}

}  // namespace

StressFit::StressFit(const MaterialModel& model, const std::vector<RubberTest>& tests, Weights weights, int terms)
    : model_(model),
      parameters_(expected_parameters(model, std::size_t(terms) * model.parameters.size())),
      observations_(all_observations(tests))
{
  if (parameters_.size() > std::size_t(Dual::variables))
    throw InputError(fmt::format("{}: {} parameters are too many: {} are the most", model.name, parameters_.size(),
                                 Dual::variables));
  const double size = stress_size();
  weights_.resize(residual_count());
  for (int i = 0; i < residual_count(); ++i) {
    const double stress = std::abs(observations_[std::size_t(i)].stress);
    weights_[i] = weights == Weights::Absolute ? 1 / size : (stress > 0 ? 1 / stress : 0);
  }
  if (informative_count() <= parameter_count())
    throw InputError(
        fmt::format("{} has {} parameters, but there are only {} measured stresses that tell of them: measure more or "
                    "take a model with fewer parameters",
                    model.name, parameters_.size(), informative_count()));
  sizes_ = Vec::Ones(parameter_count());
  for (int j = 0; j < parameter_count(); ++j)
    if (parameters_[std::size_t(j)].unit == "Pa") sizes_[j] = size;
}

int StressFit::informative_count() const
{
  int count = 0;
  for (int i = 0; i < residual_count(); ++i) {
    const auto& [l, direction, stress, line] = observations_[std::size_t(i)];
    const double third = 1 / l.prod();
    // Equal stretches along and across the sheet, as at rest: every material then has no stress.
    if (weights_[i] > 0 && std::abs(l[direction] - third) > 1e-12 * third) ++count;
  }
  return count;
}

double StressFit::stress_size() const
{
  double sum = 0;
  for (const StressObservation& observation : observations_) sum += observation.stress * observation.stress;
  return std::sqrt(sum / double(observations_.size()));
}

std::vector<double> StressFit::parameters_at(ConstVec z) const
{
  std::vector<double> p(parameters_.size());
  for (int j = 0; j < parameter_count(); ++j) p[std::size_t(j)] = is_free(j) ? z[j] : sizes_[j] * std::exp(z[j]);
  for (std::size_t j = 0; j < p.size(); ++j)
    if (const int base = parameters_[j].base; base >= 0) p[j] += parameters_[j].base_factor * p[std::size_t(base)];
  return p;
}

Eigen::MatrixXd StressFit::parameter_jacobian(ConstVec z) const
{
  const int n = parameter_count();
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(n, n);
  for (int j = 0; j < n; ++j) J(j, j) = is_free(j) ? 1 : sizes_[j] * std::exp(z[j]);
  for (int j = 0; j < n; ++j) {
    const auto& [name, unit, range, base, factor] = parameters_[std::size_t(j)];
    if (base >= 0) J(j, base) += factor * J(base, base);
  }
  return J;
}

bool StressFit::evaluate_at(const std::vector<double>& p, Vec& residuals, Eigen::MatrixXd* jacobian) const
{
  residuals.resize(residual_count());
  if (jacobian) jacobian->resize(residual_count(), parameter_count());
  for (int i = 0; i < residual_count(); ++i) {
    const auto& [stretches, direction, measured, line] = observations_[std::size_t(i)];
    residuals[i] = weights_[i] * (nominal_stress(model_, p, stretches)[direction] - measured);
    if (jacobian)
      jacobian->row(i) = weights_[i] * stress_by_parameters(model_, p, stretches).by_parameters.row(direction).matrix();
  }
  // Also where squares would overflow: a cost must be a number.
  return std::isfinite(residuals.squaredNorm()) && (!jacobian || std::isfinite(jacobian->squaredNorm()));
}

bool StressFit::evaluate(ConstVec z, Vec& residuals, Eigen::MatrixXd* jacobian) const
{
  if (!evaluate_at(parameters_at(z), residuals, jacobian)) return false;
  if (jacobian) *jacobian = (*jacobian * parameter_jacobian(z)).eval();
  return !jacobian || std::isfinite(jacobian->squaredNorm());
}

std::vector<MaterialParameter> StressFit::named_parameters(ConstVec z) const
{
  std::vector<MaterialParameter> named;
  const std::vector<double> values = parameters_at(z);
  const std::vector<bool> at_end = at_bound(z);
  for (std::size_t j = 0; j < values.size(); ++j) {
    double value = values[j];
    if (at_end[j] && parameters_[j].range == Range::NonNegative) value = 0;
    if (parameters_[j].range == Range::Positive) {  // inside, still, where the exponential has underflowed
      const double end =
          parameters_[j].base < 0 ? 0 : parameters_[j].base_factor * values[std::size_t(parameters_[j].base)];
      value = std::max(value, end + std::max(DBL_MIN, 4 * DBL_EPSILON * std::abs(end)));
    }
    named.push_back({parameters_[j].name, value, parameters_[j].unit});
  }
  return named;
}

Vec StressFit::lower_start() const
{
  Vec z(parameter_count());
  for (int j = 0; j < z.size(); ++j)
    z[j] = is_free(j) ? -5 : std::log(parameters_[std::size_t(j)].unit == "Pa" ? 1e-2 : 1e-5);
  return z;
}

Vec StressFit::upper_start() const
{
  Vec z(parameter_count());
  for (int j = 0; j < z.size(); ++j) z[j] = is_free(j) ? 8 : std::log(parameters_[std::size_t(j)].unit == "Pa" ? 3 : 2);
  return z;
}

std::vector<bool> StressFit::at_bound(ConstVec z) const
{
  Vec residuals;
  Eigen::MatrixXd J;
  std::vector<bool> bound(parameters_.size(), false);
  if (!evaluate(z, residuals, &J)) return bound;
  const double negligible = is_exact(residuals) ? exact_norm(residuals) : bound_fraction * residuals.norm();
  // dr/dz_j = (p_j - b_j) dr/dp_j: what the residuals would lose at the end of the range.
  for (int j = 0; j < parameter_count(); ++j) bound[std::size_t(j)] = !is_free(j) && J.col(j).norm() < negligible;
  return bound;
}

bool StressFit::is_minimum(ConstVec z) const
{
  Vec residuals;
  Eigen::MatrixXd J;
  if (!evaluate_at(parameters_at(z), residuals, &J)) return false;
  if (is_exact(residuals)) return true;
  // At the end of a range exp(z_j) may have vanished, and with it the slope of the cost: look at the parameter itself.
  const std::vector<bool> at_end = at_bound(z);
  Vec visible = z;
  for (int j = 0; j < parameter_count(); ++j)
    if (at_end[std::size_t(j)]) visible[j] = 0;
  J = (J * parameter_jacobian(visible)).eval();
  for (int j = 0; j < parameter_count(); ++j) {
    const double scale = J.col(j).norm() * residuals.norm();
    if (scale == 0) continue;
    const double cosine = J.col(j).dot(residuals) / scale;
    if (at_end[std::size_t(j)] ? cosine < -largest_cosine : std::abs(cosine) > largest_cosine) return false;
  }
  return true;
}

Vec StressFit::ordered(ConstVec z) const
{
  if (!model_.is_sum) return z;
  const auto size = Eigen::Index(model_.parameters.size());
  std::vector<Vec> terms;
  for (Eigen::Index j = 0; j < z.size(); j += size) terms.emplace_back(z.segment(j, size));
  std::sort(terms.begin(), terms.end(), [](const Vec& a, const Vec& b) { return a[0] > b[0]; });
  Vec sorted(z.size());
  for (std::size_t k = 0; k < terms.size(); ++k) sorted.segment(Eigen::Index(k) * size, size) = terms[k];
  return sorted;
}

namespace {

/// A point of the box where the stresses are finite: large exponents overflow at large stretches.
Vec draw_start(const StressFit& problem, std::mt19937_64& generator)
{
  const Vec lower = problem.lower_start(), upper = problem.upper_start();
  Vec residuals, z = lower;
  for (int attempt = 0; attempt < 1000; ++attempt) {
    z = draw(lower, upper, generator);
    if (problem.evaluate(z, residuals, nullptr)) break;
  }
  return z;
}

/// Adds an end of a run to the minima, or counts it where it is known.
void add_minimum(const StressFit& problem, const LeastSquaresSolution& end, std::vector<LocalMinimum>& minima)
{
  Vec residuals, known;
  problem.evaluate(end.z, residuals, nullptr);
  for (LocalMinimum& minimum : minima) {
    problem.evaluate(minimum.z, known, nullptr);
    if (!is_same_minimum(residuals, known)) continue;
    ++minimum.starts;
    if (end.cost < minimum.cost) {
      minimum.cost = end.cost;
      minimum.z = end.z;
      minimum.parameters = problem.named_parameters(end.z);
    }
    return;
  }
  minima.push_back({end.z, end.cost, 1, problem.named_parameters(end.z)});
}

}  // namespace

MaterialFit fit_material(const std::string& model_name, const std::vector<RubberTest>& tests, const FitOptions& options,
                         const FitObserver& observer)
{
  const MaterialModel& model = find_material_model(model_name);
  const LeastSquaresSolver& solver = find_least_squares_solver(options.solver);
  const StressFit problem(model, tests, options.weights, options.terms);

  MaterialFit fit;
  fit.solver = solver.name;
  bool is_at_minimum = false;
  std::mt19937_64 generator(options.seed);
  const int searches = solver.search ? 1 : 0, count = options.starts + searches;
  for (int start = 0; start < count; ++start) {
    if (observer && !observer(start, count)) break;
    const Vec from = start < searches
                         ? solver.search(problem, problem.lower_start(), problem.upper_start(), options.seed)
                         : draw_start(problem, generator);
    LeastSquaresSolution end = solver.minimize(problem, from, {});
    end.z = problem.ordered(end.z);
    const bool is_minimum = problem.is_minimum(end.z);
    if (is_minimum) add_minimum(problem, end, fit.minima);
    if (!is_minimum) ++fit.unfinished_starts;
    if (end.report.termination == Termination::NotFinite) continue;
    if (!is_minimum) fit.unfinished_cost = std::min(fit.unfinished_cost, end.cost);
    // Any minimum comes before any end that is none.
    if (is_minimum > is_at_minimum || (is_minimum == is_at_minimum && end.cost < fit.cost)) {
      is_at_minimum = is_minimum;
      fit.cost = end.cost;
      fit.z = end.z;
      fit.report = end.report;
    }
  }
  std::sort(fit.minima.begin(), fit.minima.end(), [](const auto& a, const auto& b) { return a.cost < b.cost; });
  if (fit.z.size() > 0) fit.material = model.make(model.name, problem.named_parameters(fit.z));
  return fit;
}

StressError stress_error(const Material& material, const std::vector<RubberTest>& tests)
{
  double squares = 0, relative = 0;
  int count = 0, nonzero = 0;
  for (const auto& [stretches, direction, measured, line] : all_observations(tests)) {
    const double error = nominal_stress(material, stretches)[direction] - measured;
    squares += error * error;
    ++count;
    if (measured == 0) continue;
    relative += std::abs(error / measured);
    ++nonzero;
  }
  return {std::sqrt(squares / count), relative / nonzero};
}

}  // namespace softform
