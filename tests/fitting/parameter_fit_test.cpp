// Fits of known materials and of published data: recovery, agreement of the solvers, bounds, warnings.
#include <algorithm>
#include <cmath>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "softform/fitting/trust.hpp"
#include "support/expect_input_error.hpp"
#include "support/finite_differences.hpp"
#include "support/materials.hpp"

namespace softform {
namespace {

/// A perfect test of a material.
RubberTest simulated(const Material& material, TestMode mode, double largest_stretch, int points = 12)
{
  RubberTest test{mode, to_string(mode), "", {}};
  for (int k = 1; k <= points; ++k) {
    const Stretches l = stretches_of(mode, 1 + (largest_stretch - 1) * k / points);
    test.observations.push_back({l, 0, nominal_stress(material, l)[0], k});
  }
  return test;
}

std::vector<RubberTest> three_modes(const Material& material)
{
  return {simulated(material, TestMode::Uniaxial, 4), simulated(material, TestMode::Equibiaxial, 3),
          simulated(material, TestMode::PureShear, 3.5)};
}

std::vector<RubberTest> treloar()
{
  return {load_rubber_test("treloar_1944_uniaxial"), load_rubber_test("treloar_1944_pure_shear"),
          load_rubber_test("treloar_1944_sheet_inflation")};
}

FitOptions options_with(const std::string& solver, Weights weights = Weights::Absolute)
{
  FitOptions options;
  options.solver = solver;
  options.weights = weights;
  return options;
}

const std::vector<std::string> solver_names{"ceres", "nlopt", "gauss_newton"};

/// A material well inside its range.
std::unique_ptr<Material> known_material(const std::string& model)
{
  if (model == "st_venant_kirchhoff") return make_material(model, {{"lambda", 1e5}, {"mu", 3e5}});
  if (model == "ogden")
    return make_material(model, {{"mu_1", 3e5}, {"alpha_1", 1.4}, {"mu_2", 2e4}, {"alpha_2", -2.5}});
  if (model == "hart_smith") return make_material(model, {{"G", 1.6e5}, {"k1", 0.01}, {"k2", 0.4}});
  return testing::example_of(model);
}

class Fit : public ::testing::TestWithParam<std::string> {};

INSTANTIATE_TEST_SUITE_P(Registry, Fit, ::testing::ValuesIn(testing::model_names()),
                         [](const auto& test) { return test.param; });

TEST_P(Fit, EverySolverRecoversAKnownMaterial)
{
  const auto truth = known_material(GetParam());
  const auto tests = three_modes(*truth);
  for (const std::string& solver : solver_names) {
    for (const Weights weights : {Weights::Absolute, Weights::Relative}) {
      const MaterialFit fit = fit_material(GetParam(), tests, options_with(solver, weights));
      ASSERT_TRUE(fit.material);
      EXPECT_EQ(fit.minima.size(), 1u) << solver;
      const auto found = fit.material->parameters(), expected = truth->parameters();
      ASSERT_EQ(found.size(), expected.size());
      for (std::size_t j = 0; j < found.size(); ++j) {
        EXPECT_EQ(found[j].name, expected[j].name);
        // Ogden's and Hart-Smith's are ill-conditioned, and NLopt has no derivatives.
        EXPECT_NEAR(found[j].value / expected[j].value, 1, solver == "nlopt" ? 2e-3 : 1e-6) << solver << found[j].name;
      }
      EXPECT_LT(stress_error(*fit.material, tests).rms, 1e-4 * tests[0].largest_stress());
    }
  }
}

TEST_P(Fit, TransformKeepsParametersAdmissibleAndHasRightSlopes)
{
  const StressFit problem(find_material_model(GetParam()), three_modes(*known_material(GetParam())), Weights::Relative,
                          2);
  Vec z(problem.parameter_count());
  for (Eigen::Index j = 0; j < z.size(); ++j) z[j] = -4 + 0.7 * double(j);
  Vec residuals;
  Eigen::MatrixXd J;
  ASSERT_TRUE(problem.evaluate(z, residuals, &J));
  for (Eigen::Index j = 0; j < z.size(); ++j) {
    const auto r = [&](const Vec& at) {
      Vec value;
      problem.evaluate(at, value, nullptr);
      return value;
    };
    const auto check = testing::check_slope(r, z, Vec::Unit(z.size(), j), J.col(j), 1e-2, 1e-6);
    EXPECT_TRUE(check.passes()) << j << ": " << check;
  }
  for (const double extreme : {-50.0, -3.0, 3.0}) {
    for (Eigen::Index j = 0; j < z.size(); ++j) {
      Vec far = z;
      far[j] = extreme;
      std::map<std::string, double> parameters;
      for (const auto& [name, value, unit] : problem.named_parameters(far)) parameters[name] = value;
      EXPECT_NO_THROW(make_material(GetParam(), parameters)) << "variable " << j << " at " << extreme;
    }
  }
}

TEST_P(Fit, SolversAgreeOnPublishedData)
{
  const std::vector<std::vector<RubberTest>> sets{
      treloar(),
      {load_rubber_test("treloar_1944_latex_equibiaxial")},
      {load_rubber_test("meunier_2008_silicone_uniaxial"), load_rubber_test("meunier_2008_silicone_equibiaxial")}};
  for (const auto& tests : sets) {
    std::vector<double> costs;
    for (const std::string& solver : solver_names) {
      const MaterialFit fit = fit_material(GetParam(), tests, options_with(solver));
      ASSERT_FALSE(fit.minima.empty()) << solver;
      EXPECT_EQ(fit.minima.front().cost, fit.cost) << solver;
      costs.push_back(fit.cost);
    }
    const auto [least, largest] = std::minmax_element(costs.begin(), costs.end());
    EXPECT_LT(*largest / *least - 1, 1e-6) << tests.front().name;
  }
}

TEST(HartSmithFit, TreloarsInflatedSheet)
{
  const std::vector<RubberTest> tests{load_rubber_test("treloar_1944_sheet_inflation")};
  const MaterialFit fit = fit_material("hart_smith", tests, options_with("gauss_newton"));
  const auto p = fit.material->parameters();
  EXPECT_LT(stress_error(*fit.material, tests).rms, 0.0155e6);
  EXPECT_NEAR(p[0].value, 0.1848e6, 0.001e6);
  EXPECT_NEAR(p[1].value, 2.85e-4, 0.05e-4);
  EXPECT_NEAR(p[2].value, 0.283, 0.003);
}

TEST(OgdenFit, PublishedSetOnTreloarsData)
{
  // Ogden 1972: mu = 0.6178, 0.001177, -0.009807 MPa, alpha = 1.3, 5, -2; here mu_j = alpha mu/2.
  const auto published = make_material("ogden", {{"mu_1", 0.6178e6 * 1.3 / 2},
                                                 {"alpha_1", 1.3},
                                                 {"mu_2", 0.001177e6 * 5 / 2},
                                                 {"alpha_2", 5},
                                                 {"mu_3", -0.009807e6 * -2 / 2},
                                                 {"alpha_3", -2}});
  const double error = stress_error(*published, treloar()).mean_relative;
  EXPECT_GT(error, 0.05);
  EXPECT_LT(error, 0.06);
}

TEST(Fit, FollowsAPlainLineExactly)
{
  // Neo-Hookean stress is linear in mu: the least-squares answer is a ratio of sums.
  const auto test = load_rubber_test("treloar_1944_uniaxial");
  double numerator = 0, denominator = 0, relative_numerator = 0, relative_denominator = 0;
  for (const auto& [stretches, direction, stress, line] : test.observations) {
    const double L = stretches[0], f = L - 1 / (L * L);
    numerator += f * stress;
    denominator += f * f;
    if (stress == 0) continue;
    relative_numerator += f / stress;
    relative_denominator += f * f / (stress * stress);
  }
  for (const std::string& solver : solver_names) {
    const auto absolute = fit_material("neo_hookean", {test}, options_with(solver));
    const auto relative = fit_material("neo_hookean", {test}, options_with(solver, Weights::Relative));
    EXPECT_NEAR(absolute.material->shear_modulus() / (numerator / denominator), 1, 1e-7) << solver;
    EXPECT_NEAR(relative.material->shear_modulus() / (relative_numerator / relative_denominator), 1, 1e-7) << solver;
  }
}

TEST(Fit, RefusesWhatCannotBeFitted)
{
  const auto neo = make_material("neo_hookean", {{"mu", 3e5}});
  const std::vector<RubberTest> three_points{simulated(*neo, TestMode::Uniaxial, 2, 3)};
  test::expect_input_error([&] { fit_material("hart_smith", three_points, {}); },
                           {"hart_smith", "3 parameters", "3 measured", "measure more"});
  test::expect_input_error([&] { fit_material("jelly", three_points, {}); }, {"jelly", "hart_smith"});
  test::expect_input_error([&] { fit_material("neo_hookean", three_points, options_with("magic")); },
                           {"magic", "ceres"});
  EXPECT_TRUE(fit_material("mooney_rivlin", three_points, {}).material);
  auto with_rest = three_points;
  with_rest[0].observations.insert(with_rest[0].observations.begin(), {Stretches(1, 1), 0, 0, 1});
  test::expect_input_error([&] { fit_material("hart_smith", with_rest, {}); }, {"3 parameters", "3 measured"});
}

bool any_contains(const std::vector<std::string>& messages, const std::string& words)
{
  return std::any_of(messages.begin(), messages.end(),
                     [&](const std::string& message) { return message.find(words) != std::string::npos; });
}

/// The rms error [Pa] that a cost with absolute weights stands for.
double rms_of_cost(double cost, const std::vector<RubberTest>& tests)
{
  double squares = 0, count = 0;
  for (const RubberTest& test : tests) {
    for (const StressObservation& observation : test.observations) {
      squares += observation.stress * observation.stress;
      ++count;
    }
  }
  return std::sqrt(2 * cost * squares) / count;  // the weight is that of the mean square
}

TEST(Fit, ReportsTheMaterialThatItFitted)
{
  // With four terms an exponent of -32 gives 1e-3 Pa too much of a modulus a rms of 1e9 Pa.
  FitOptions options = options_with("ceres");
  options.terms = 4;
  const std::vector<RubberTest> uniaxial{load_rubber_test("treloar_1944_uniaxial")};
  const MaterialFit four_terms = fit_material("ogden", uniaxial, options);
  EXPECT_NEAR(stress_error(*four_terms.material, uniaxial).rms / rms_of_cost(four_terms.cost, uniaxial), 1, 1e-6);
  for (const std::string& model : testing::model_names()) {
    const MaterialFit fit = fit_material(model, treloar(), {});
    EXPECT_NEAR(stress_error(*fit.material, treloar()).rms / rms_of_cost(fit.cost, treloar()), 1, 1e-6) << model;
  }
}

TEST(Fit, ChoosesAMinimumBeforeALowerEndThatIsNone)
{
  FitOptions options = options_with("gauss_newton");
  options.terms = 3;
  const std::vector<RubberTest> tests{load_rubber_test("meunier_2008_silicone_equibiaxial")};
  const MaterialFit fit = fit_material("ogden", tests, options);
  ASSERT_FALSE(fit.minima.empty());
  EXPECT_EQ(fit.cost, fit.minima.front().cost);
  EXPECT_LT(fit.unfinished_cost, fit.cost);
  const StressFit problem(find_material_model("ogden"), tests, Weights::Absolute, 3);
  EXPECT_TRUE(problem.is_minimum(fit.z));
  EXPECT_TRUE(any_contains(warnings(fit, uncertainty(problem, fit.z), {}, tests), "came lower"));
}

TEST(Fit, IsRepeatable)
{
  const std::vector<RubberTest> tests{load_rubber_test("meunier_2008_silicone_equibiaxial")};
  for (const std::string& solver : solver_names)
    EXPECT_EQ(fit_material("hart_smith", tests, options_with(solver)).z,
              fit_material("hart_smith", tests, options_with(solver)).z)
        << solver;
}

std::vector<std::string> warnings_of(const std::string& model, const std::vector<RubberTest>& tests)
{
  const MaterialFit fit = fit_material(model, tests, {});
  const StressFit problem(find_material_model(model), tests, Weights::Absolute, 2);
  return warnings(fit, uncertainty(problem, fit.z), find_instabilities(*fit.material, tests), tests);
}

TEST(Trust, StandardErrorsAreThoseOfALinearModel)
{
  const std::vector<RubberTest> tests{load_rubber_test("meunier_2008_silicone_uniaxial"),
                                      load_rubber_test("meunier_2008_silicone_equibiaxial")};
  const MaterialFit fit = fit_material("mooney_rivlin", tests, {});
  const StressFit problem(find_material_model("mooney_rivlin"), tests, Weights::Absolute, 2);
  const Uncertainty u = uncertainty(problem, fit.z);

  // P is linear in mu_1 and mu_2: the covariance is that of a linear regression.
  std::vector<Eigen::Vector2d> rows;
  double squares = 0;
  for (const RubberTest& test : tests) {
    for (const auto& [l, direction, stress, line] : test.observations) {
      const double f = l[0] - 1 / (l[0] * l[0] * l[0] * l[1] * l[1]);
      if (f == 0) continue;  // at rest
      rows.emplace_back(f, f * l[1] * l[1]);
      squares += std::pow(nominal_stress(*fit.material, l)[0] - stress, 2);
    }
  }
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  for (const auto& row : rows) normal += row * row.transpose();
  const double determinant = normal.determinant(), variance = squares / double(rows.size() - 2);
  EXPECT_NEAR(u.standard_errors[0] / std::sqrt(variance * normal(1, 1) / determinant), 1, 1e-6);
  EXPECT_NEAR(u.standard_errors[1] / std::sqrt(variance * normal(0, 0) / determinant), 1, 1e-6);
  EXPECT_NEAR(u.correlation(0, 1), -normal(0, 1) / std::sqrt(normal(0, 0) * normal(1, 1)), 1e-6);
  EXPECT_NEAR(u.correlation(0, 0), 1, 1e-12);
  EXPECT_GT(u.condition_number, 1);
}

TEST(Trust, PointsAtRestAddNoConfidence)
{
  auto tests = treloar();
  const auto errors = [&](Weights weights) {
    const MaterialFit fit = fit_material("hart_smith", tests, options_with("gauss_newton", weights));
    return uncertainty(StressFit(find_material_model("hart_smith"), tests, weights, 1), fit.z).standard_errors;
  };
  const auto absolute = errors(Weights::Absolute), relative = errors(Weights::Relative);
  for (RubberTest& test : tests) test.observations.insert(test.observations.begin(), 10, {Stretches(1, 1), 0, 0, 1});
  const auto absolute_with_rest = errors(Weights::Absolute), relative_with_rest = errors(Weights::Relative);
  for (std::size_t j = 0; j < absolute.size(); ++j) {
    EXPECT_NEAR(absolute_with_rest[j] / absolute[j], 1, 1e-5);
    EXPECT_NEAR(relative_with_rest[j] / relative[j], 1, 1e-5);
  }
}

TEST(Trust, ExactDataDoNotHideWhatTheyDetermine)
{
  const auto truth = make_material("neo_hookean", {{"mu", 3e5}});
  for (const std::string& solver : solver_names) {
    const std::vector<RubberTest> tests{simulated(*truth, TestMode::Uniaxial, 4)};
    const MaterialFit fit = fit_material("hart_smith", tests, options_with(solver));
    const StressFit problem(find_material_model("hart_smith"), tests, Weights::Absolute, 1);
    const Uncertainty u = uncertainty(problem, fit.z);
    EXPECT_LT(u.standard_errors[0], 1) << solver;  // of G = 150 kPa
    EXPECT_FALSE(any_contains(warnings(fit, u, {}, tests), "fit exactly as well")) << solver;
  }
}

TEST(Trust, WarnsOfWhatTheDataCannotTell)
{
  // In pure shear I1 = I2: Mooney-Rivlin's parameters are one.
  const std::vector<RubberTest> shear{load_rubber_test("treloar_1944_pure_shear")};
  EXPECT_TRUE(any_contains(warnings_of("mooney_rivlin", shear), "not identifiable from pure_shear"));
  EXPECT_TRUE(any_contains(warnings_of("mooney_rivlin", shear), "one mode alone (pure_shear)"));
  EXPECT_TRUE(any_contains(warnings_of("hart_smith", shear), "one mode alone"));
  EXPECT_FALSE(any_contains(warnings_of("neo_hookean", shear), "one mode alone"));
  EXPECT_FALSE(any_contains(warnings_of("hart_smith", treloar()), "one mode alone"));
  // Uniaxial tension alone would have mu_2 negative.
  EXPECT_TRUE(
      any_contains(warnings_of("mooney_rivlin", {load_rubber_test("treloar_1944_uniaxial")}), "end of its range"));
  EXPECT_TRUE(any_contains(warnings_of("neo_hookean", treloar()), "does not follow these data"));
}

TEST(Trust, StabilityIsThatOfTheMaterial)
{
  const auto tests = treloar();
  EXPECT_TRUE(find_instabilities(*make_material("neo_hookean", {{"mu", 3e5}}), tests).empty());
  EXPECT_TRUE(
      find_instabilities(*make_material("hart_smith", {{"G", 1.8e5}, {"k1", 3e-4}, {"k2", 0.3}}), tests).empty());
  // St. Venant-Kirchhoff with lambda < 0 loses the order of stresses; its uniaxial work turns at a finite stretch.
  const auto soft = find_instabilities(*make_material("st_venant_kirchhoff", {{"lambda", -6e4}, {"mu", 1e5}}), tests);
  ASSERT_FALSE(soft.empty());
  for (const Instability& instability : soft) EXPECT_GT(instability.stretch, 1);
}

TEST(Trust, PredictionsOfAKnownMaterialAreExact)
{
  const auto truth = known_material("mooney_rivlin");
  const auto matrix = cross_prediction(
      "mooney_rivlin", {simulated(*truth, TestMode::Uniaxial, 3), simulated(*truth, TestMode::Equibiaxial, 2.5)}, {});
  ASSERT_EQ(matrix.size(), 6u);  // each alone and all, on each
  for (const auto& [fitted_on, predicted, error] : matrix)
    EXPECT_LT(error.mean_relative, 1e-6) << fitted_on << predicted;
}

TEST(Trust, ATestWithTooFewPointsLeavesAGapInThePredictions)
{
  const auto truth = known_material("hart_smith");
  const auto matrix = cross_prediction(
      "hart_smith", {simulated(*truth, TestMode::Uniaxial, 3, 3), simulated(*truth, TestMode::Equibiaxial, 2.5)}, {});
  ASSERT_EQ(matrix.size(), 6u);
  for (const auto& [fitted_on, predicted, error] : matrix)
    EXPECT_EQ(std::isnan(error.rms), fitted_on == "uniaxial") << fitted_on << predicted;
  test::expect_input_error([&] { cross_prediction("jelly", treloar(), {}); }, {"jelly"});
}

}  // namespace
}  // namespace softform
