#include "softform/fitting/trust.hpp"

#include <cmath>
#include <limits>
#include <set>

#include <Eigen/Eigenvalues>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "softform/core/error.hpp"

namespace softform {
namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// A problem with some of its variables held where they are.
class HeldProblem final : public LeastSquaresProblem {
 public:
  HeldProblem(const LeastSquaresProblem& problem, ConstVec z, std::vector<int> free)
      : problem_(problem), z_(z), free_(std::move(free))
  {}
  int parameter_count() const override { return static_cast<int>(free_.size()); }
  int residual_count() const override { return problem_.residual_count(); }
  bool evaluate(ConstVec y, Vec& residuals, Eigen::MatrixXd* jacobian) const override
  {
    Vec z = z_;
    z(free_) = y;
    Eigen::MatrixXd whole;
    if (!problem_.evaluate(z, residuals, jacobian ? &whole : nullptr)) return false;
    if (jacobian) *jacobian = whole(Eigen::all, free_);
    return true;
  }

 private:
  const LeastSquaresProblem& problem_;
  Vec z_;
  std::vector<int> free_;
};

std::vector<int> free_variables(const StressFit& problem, ConstVec z)
{
  std::vector<int> free;
  const std::vector<bool> at_bound = problem.at_bound(z);
  for (int j = 0; j < problem.parameter_count(); ++j)
    if (!at_bound[std::size_t(j)]) free.push_back(j);
  return free;
}

/// (J^T J)^-1 in relative parameters: those that are free of bounds and signs are scaled by their value.
double condition_number(const Eigen::MatrixXd& inverse, const StressFit& problem, ConstVec z,
                        const std::vector<int>& free)
{
  Vec relative(inverse.rows());
  for (Eigen::Index k = 0; k < relative.size(); ++k) {
    const auto j = std::size_t(free[std::size_t(k)]);
    const bool is_real = problem.parameters()[j].range == Range::Real;
    relative[k] = is_real ? 1 / std::abs(z[Eigen::Index(j)]) : 1;
  }
  const Eigen::MatrixXd scaled = relative.asDiagonal() * inverse * relative.asDiagonal();
  const Vec eigenvalues = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(scaled, Eigen::EigenvaluesOnly).eigenvalues();
  return std::sqrt(eigenvalues[eigenvalues.size() - 1] / eigenvalues[0]);
}

}  // namespace

Uncertainty uncertainty(const StressFit& problem, ConstVec z)
{
  const int n = problem.parameter_count();
  Uncertainty result{std::vector<double>(std::size_t(n), not_a_number), Eigen::MatrixXd::Constant(n, n, not_a_number),
                     std::numeric_limits<double>::infinity()};
  const std::vector<int> free = free_variables(problem, z);
  const HeldProblem held(problem, z, free);
  const auto inverse = inverse_normal_matrix(held, Vec(z(free)));
  Vec residuals;
  if (!inverse || !problem.evaluate(z, residuals, nullptr)) return result;

  const double variance = residuals.squaredNorm() / double(problem.informative_count() - int(free.size()));
  const Eigen::MatrixXd to_parameters = problem.parameter_jacobian(z)(Eigen::all, free);
  const Eigen::MatrixXd covariance = variance * to_parameters * *inverse * to_parameters.transpose();
  for (const int i : free) {
    result.standard_errors[std::size_t(i)] = std::sqrt(covariance(i, i));
    for (const int j : free)
      result.correlation(i, j) = covariance(i, j) / std::sqrt(covariance(i, i) * covariance(j, j));
  }
  result.condition_number = condition_number(*inverse, problem, z, free);
  return result;
}

namespace {

double first_invariant(const Stretches& l) { return l.square().sum() + 1 / l.square().prod(); }

const char* violated_criterion(const Material& material, const Stretches& l)
{
  const Eigen::Array2d tau = l * nominal_stress(material, l);
  const double third = 1 / l.prod();
  const auto is_ordered = [](double stress, double stretch) {
    return std::abs(stretch) < 1e-9 || stress * stretch > 0;
  };
  if (!is_ordered(tau[0] - tau[1], l[0] - l[1]) || !is_ordered(tau[0], l[0] - third) ||
      !is_ordered(tau[1], l[1] - third))
    return "Baker-Ericksen";
  const Eigen::Matrix2d H = logarithmic_stiffness(material, l);
  return H(0, 0) > 0 && H.determinant() > 0 ? nullptr : "Drucker";
}

}  // namespace

std::vector<Instability> find_instabilities(const Material& material, const std::vector<RubberTest>& tests)
{
  double largest_invariant = 3;
  bool has_compression = false;
  for (const RubberTest& test : tests) {
    for (const StressObservation& observation : test.observations) {
      largest_invariant = std::max(largest_invariant, first_invariant(observation.stretches));
      has_compression = has_compression || observation.stretches[0] < 1;
    }
  }
  std::vector<Instability> found;
  for (const TestMode mode : {TestMode::Uniaxial, TestMode::Equibiaxial, TestMode::PureShear}) {
    for (const double factor : {1.005, 1 / 1.005}) {
      if (factor < 1 && !has_compression) continue;
      for (double stretch = factor; first_invariant(stretches_of(mode, stretch)) <= largest_invariant;
           stretch *= factor) {
        if (const char* criterion = violated_criterion(material, stretches_of(mode, stretch))) {
          found.push_back({mode, criterion, stretch});
          break;
        }
      }
    }
  }
  return found;
}

namespace {

std::string mode_names(const std::vector<RubberTest>& tests)
{
  std::set<std::string> names;
  for (const RubberTest& test : tests) names.insert(to_string(test.mode));
  return fmt::format("{}", fmt::join(names, ", "));
}

/// Tests of these modes tell parameters apart; inflation and equibiaxial are the same deformation.
std::size_t distinct_modes(const std::vector<RubberTest>& tests)
{
  std::set<TestMode> modes;
  for (const RubberTest& test : tests) {
    if (test.mode == TestMode::Biaxial) return 2;  // sweeps both invariants
    modes.insert(test.mode == TestMode::Inflation ? TestMode::Equibiaxial : test.mode);
  }
  return modes.size();
}

void warn_of_parameters(const Material& material, const Uncertainty& uncertainty, const std::string& modes,
                        std::vector<std::string>& warnings)
{
  const auto parameters = material.parameters();
  for (std::size_t j = 0; j < parameters.size(); ++j) {
    const auto& [name, value, unit] = parameters[j];
    const double error = uncertainty.standard_errors[j];
    const std::string what = fmt::format("{} = {:.4g}{}", name, value, unit == "1" ? "" : " " + unit);
    if (error > 0.5 * std::abs(value))
      warnings.push_back(
          fmt::format("{} is not identifiable from {}: its standard error is {:.2g}", what, modes, error));
    if (!std::isfinite(uncertainty.condition_number))
      warnings.push_back(fmt::format("{} is not identifiable from {}: other values fit exactly as well", what, modes));
    else if (!std::isfinite(error))
      warnings.push_back(fmt::format("{} is at the end of its range: the data would have it there or beyond", what));
    if (unit == "1" && std::abs(value) > 20)
      warnings.push_back(fmt::format("{} = {:.4g} is unlike any rubber", name, value));
    for (std::size_t i = 0; i < j; ++i) {
      const double correlation = uncertainty.correlation(Eigen::Index(i), Eigen::Index(j));
      if (std::abs(correlation) > 0.99)
        warnings.push_back(fmt::format("{} and {} are not identifiable apart from {}: their correlation is {:.4f}",
                                       parameters[i].name, name, modes, correlation));
    }
  }
  const double modulus = material.shear_modulus();
  if (modulus < 1e4 || modulus > 1e8)
    warnings.push_back(fmt::format("the shear modulus at rest, {:.3g} Pa, is unlike any rubber", modulus));
}

}  // namespace

std::vector<std::string> warnings(const MaterialFit& fit, const Uncertainty& uncertainty,
                                  const std::vector<Instability>& instabilities, const std::vector<RubberTest>& tests)
{
  std::vector<std::string> warnings;
  const Material& material = *fit.material;
  const std::string modes = mode_names(tests);
  if (distinct_modes(tests) < 2 && material.parameters().size() > 1)
    warnings.push_back(
        fmt::format("one mode alone ({}) does not determine {}'s {} parameters: other modes are "
                    "extrapolated; add a test in a second mode",
                    modes, material.model(), material.parameters().size()));
  warn_of_parameters(material, uncertainty, modes, warnings);
  if (fit.minima.empty())
    warnings.push_back("no start ended in a minimum: these are the parameters of least cost on the way");
  else if (fit.unfinished_cost < (1 - 1e-6) * fit.cost)  // lower by more than the search's last steps
    warnings.push_back(
        fmt::format("a start that did not end in a minimum came lower (cost {:.6g} against {:.6g}): more starts, fewer "
                    "terms or another solver may find a better fit",
                    fit.unfinished_cost, fit.cost));
  for (std::size_t k = 1; k < fit.minima.size(); ++k)
    if (fit.minima[k].cost < 1.2 * fit.cost)
      warnings.push_back(fmt::format("another minimum fits nearly as well (cost {:.6g} against {:.6g})",
                                     fit.minima[k].cost, fit.cost));
  for (const auto& [mode, criterion, stretch] : instabilities)
    warnings.push_back(
        fmt::format("unstable by {}'s criterion in the {} mode at a stretch of {:.3g}, within the range "
                    "of the data",
                    criterion, to_string(mode), stretch));
  if (const StressError error = stress_error(material, tests); error.mean_relative > 0.2)
    warnings.push_back(
        fmt::format("it does not follow these data: its mean relative error is {:.0f} %", 100 * error.mean_relative));
  return warnings;
}

std::vector<Prediction> cross_prediction(const std::string& model, const std::vector<RubberTest>& tests,
                                         const FitOptions& options)
{
  find_material_model(model);  // an unknown name throws here: below, InputError means too few points
  find_least_squares_solver(options.solver);
  std::vector<Prediction> matrix;
  const auto predict_all = [&](const std::string& name, const std::vector<RubberTest>& fitted) {
    std::shared_ptr<const Material> material;
    try {
      material = fit_material(model, fitted, options).material;
    } catch (const InputError&) {  // fewer points than parameters: a gap in the matrix, not its end
    }
    for (const RubberTest& test : tests)
      matrix.push_back({name, to_string(test.mode),
                        material ? stress_error(*material, {test}) : StressError{not_a_number, not_a_number}});
  };
  for (const RubberTest& test : tests) predict_all(to_string(test.mode), {test});
  if (tests.size() > 1) predict_all("all", tests);
  return matrix;
}

}  // namespace softform
