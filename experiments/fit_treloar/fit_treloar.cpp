// Purpose: are the fits of 4.3.2 to be trusted? The five models of appendix A are fitted to published tests of rubber
// (Treloar 1944, Meunier 2008) by minimising
//     1/2 sum_i (P_i(p) - P_i)^2 / mean(P^2)
// over the admissible parameters p, with three solvers from the same random starts, and judged on the modes of
// deformation that they were not fitted to. Claims: where the minimum is unique, the solvers agree; elsewhere the
// minima are listed. A parameter set that others published for the same data is as good as they say.

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <fmt/format.h>

#include "softform/core/statistics.hpp"
#include "softform/experiment/experiment.hpp"
#include "softform/experiment/run.hpp"
#include "softform/fitting/trust.hpp"
#include "softform/io/text_file.hpp"
#include "softform/materials/material_file.hpp"

namespace {

using namespace softform;

using Tests = std::vector<RubberTest>;

// Every published test alone, and those of one rubber together.
std::map<std::string, Tests> data_sets(bool with_other_rubbers)
{
  const auto uniaxial = load_rubber_test("treloar_1944_uniaxial"), shear = load_rubber_test("treloar_1944_pure_shear"),
             sheet = load_rubber_test("treloar_1944_sheet_inflation");
  std::map<std::string, Tests> sets{{"treloar", {uniaxial, shear, sheet}}, {"treloar_inflation", {sheet}}};
  if (with_other_rubbers) {
    const auto stretched = load_rubber_test("meunier_2008_silicone_uniaxial"),
               bulged = load_rubber_test("meunier_2008_silicone_equibiaxial");
    sets["treloar_uniaxial"] = {uniaxial};
    sets["treloar_pure_shear"] = {shear};
    sets["treloar_latex"] = {load_rubber_test("treloar_1944_latex_equibiaxial")};
    sets["meunier"] = {stretched, bulged};
    sets["meunier_uniaxial"] = {stretched};
    sets["meunier_equibiaxial"] = {bulged};
  }
  return sets;
}

FitOptions options_with(const std::string& solver, unsigned seed)
{
  FitOptions options;
  options.solver = solver;
  options.seed = seed;
  return options;
}

std::string described(const std::vector<MaterialParameter>& parameters)
{
  std::string text;
  for (const auto& [name, value, unit] : parameters) text += fmt::format(" {}={:.6g}", name, value);
  return text;
}

// Largest relative difference of the solvers' least costs; `lists` gets a line for each minimum.
struct Agreement {
  double difference = 0;
  bool is_unique = true;
};

Agreement compare_solvers(const std::string& set, const Tests& tests, const std::string& model, unsigned seed,
                          std::string& list)
{
  std::vector<double> costs;
  Agreement agreement;
  for (const LeastSquaresSolver& solver : least_squares_solvers()) {
    const MaterialFit fit = fit_material(model, tests, options_with(solver.name, seed));
    costs.push_back(fit.cost);
    agreement.is_unique = agreement.is_unique && fit.minima.size() == 1;
    for (const LocalMinimum& minimum : fit.minima)
      list += fmt::format("{},{},{},{},{},{}\n", set, model, solver.name, minimum.cost, minimum.starts,
                          described(minimum.parameters));
  }
  const auto [least, largest] = std::minmax_element(costs.begin(), costs.end());
  agreement.difference = *largest / *least - 1;  // NaN where no start of a solver was finite
  return agreement;
}

void compare_all_solvers(Run& run, const std::map<std::string, Tests>& sets)
{
  std::string minima = "data,model,solver,cost,starts,parameters\n";
  double unique_difference = std::numeric_limits<double>::quiet_NaN(), difference = 0;  // NaN until one is unique
  int unique = 0, several = 0;
  for (const auto& [set, tests] : sets) {
    for (const MaterialModel& model : material_models()) {
      run.step(fmt::format("three solvers: {} on {}", model.name, set));
      const Agreement agreement = compare_solvers(set, tests, model.name, run.seed(), minima);
      difference = max_or_nan(difference, agreement.difference);
      if (agreement.is_unique)
        unique_difference = unique == 0 ? agreement.difference : max_or_nan(unique_difference, agreement.difference);
      ++(agreement.is_unique ? unique : several);
    }
  }
  write_text(run.path("minima.csv"), minima);
  run.metric("cost_difference_unique_minimum", unique_difference, "1");
  run.metric("cost_difference_all", difference, "1");
  run.metric("fits_with_one_minimum", unique, "1");
  run.metric("fits_with_several_minima", several, "1");
}

// Root mean square error [Pa] and parameters of Hart-Smith on the inflated sheet alone.
void fit_inflated_sheet(Run& run, const Tests& sheet)
{
  const MaterialFit fit = fit_material("hart_smith", sheet, options_with("ceres", run.seed()));
  run.metric("rms_hart_smith_inflation", stress_error(*fit.material, sheet).rms, "Pa");
  for (const auto& [name, value, unit] : fit.material->parameters())
    run.metric(name + "_hart_smith_inflation", value, unit);
}

// Stress-stretch curves of every model fitted to all of Treloar's tests, beside the measured points.
void draw_curves(Run& run, const Tests& tests)
{
  std::map<std::string, std::shared_ptr<const Material>> materials;
  std::vector<Column> columns{{"stretch", "1"}};
  for (const MaterialModel& model : material_models()) {
    const MaterialFit fit = fit_material(model.name, tests, options_with("gauss_newton", run.seed()));
    materials[model.name] = fit.material;
    columns.push_back({model.name, "Pa"});
    run.metric("rms_" + model.name, stress_error(*fit.material, tests).rms, "Pa");
    run.metric("mean_relative_error_" + model.name, stress_error(*fit.material, tests).mean_relative, "1");
  }
  for (const RubberTest& test : tests) {
    auto& measured = run.series(fmt::format("measured_{}", to_string(test.mode)), {{"stretch", "1"}, {"stress", "Pa"}});
    for (const StressObservation& observation : test.observations)
      measured.add_row({observation.stretches[0], observation.stress});
    auto& curves = run.series(fmt::format("fitted_{}", to_string(test.mode)), columns);
    constexpr int samples = 100;
    const double last = test.observations.back().stretches[0];
    for (int k = 0; k <= samples; ++k) {
      const double stretch = 1 + (last - 1) * k / samples;
      std::vector<double> row{stretch};
      for (const MaterialModel& model : material_models())
        row.push_back(nominal_stress(*materials[model.name], stretches_of(test.mode, stretch))[0]);
      curves.add_row(row);
    }
  }
}

using Errors = std::map<std::string, double>;  // of each model

std::string least_of(const Errors& errors)
{
  for (const auto& [model, error] : errors)
    if (std::isnan(error)) return "unknown";
  return std::min_element(errors.begin(), errors.end(), [](auto& a, auto& b) { return a.second < b.second; })->first;
}

// What the numbers say, in words: summary.txt.
std::string summary(const Errors& worst, int best_cells, std::size_t cells)
{
  std::string text = "Worst mean error on a mode that was not fitted:";
  for (const auto& [model, error] : worst) text += fmt::format(" {} {:.3g} %,", model, 100 * error);
  text.back() = '.';
  return text + fmt::format(" Least: {}. Of the {} predictions hart_smith is the best in {}.\n", least_of(worst), cells,
                            best_cells);
}

// Fitted on one mode, how large is the mean relative error on the others?
void predict_other_modes(Run& run, const Tests& tests)
{
  std::string table = "model,fitted_on,predicted,rms [Pa],mean_relative_error\n";
  Errors worst;
  std::map<std::string, Errors> cells;  // a mode fitted and another predicted
  for (const MaterialModel& model : material_models()) {
    for (const auto& [fitted_on, predicted, error] :
         cross_prediction(model.name, tests, options_with("gauss_newton", run.seed()))) {
      table += fmt::format("{},{},{},{},{}\n", model.name, fitted_on, predicted, error.rms, error.mean_relative);
      if (fitted_on == "all" || fitted_on == predicted) continue;
      worst[model.name] = max_or_nan(worst[model.name], error.mean_relative);
      cells[fitted_on + " to " + predicted][model.name] = error.mean_relative;
    }
    run.metric("worst_prediction_" + model.name, worst[model.name], "1");
  }
  write_text(run.path("cross_prediction.csv"), table);

  double next = std::numeric_limits<double>::infinity();
  for (const auto& [model, error] : worst)
    if (model != "hart_smith") next = -max_or_nan(-next, -error);
  const auto best_cells =
      std::count_if(cells.begin(), cells.end(), [](const auto& cell) { return least_of(cell.second) == "hart_smith"; });
  run.metric("worst_prediction_ratio_next_best", next / worst["hart_smith"], "1");
  run.metric("share_of_predictions_best_by_hart_smith", double(best_cells) / double(cells.size()), "1");
  const std::string text = summary(worst, int(best_cells), cells.size());
  run.log(text);
  write_text(run.path("summary.txt"), text);
}

void fit_published_tests(Run& run)
{
  const auto sets = data_sets(run.is_paper());
  const Tests& treloar = sets.at("treloar");

  // 1. Parameters published for these data, evaluated on them.
  run.metric("mean_relative_error_ogden_1972", stress_error(*load_material("ogden_1972"), treloar).mean_relative, "1");

  // 2. One fit in detail, and every model on all three modes.
  fit_inflated_sheet(run, sets.at("treloar_inflation"));
  run.step("curves");
  draw_curves(run, treloar);

  // 3. What a fit to one mode says of the others.
  run.step("cross prediction");
  predict_other_modes(run, treloar);

  // 4. The three solvers on everything.
  run.time("solvers", [&] { compare_all_solvers(run, sets); });
}

}  // namespace

int main(int argc, char** argv)
{
  return softform::run_experiment(argc, argv,
                                  {"fit_treloar",
                                   "4.3.2",
                                   "Fits to published rubber tests: three solvers agree, and on modes that were not "
                                   "fitted Hart-Smith has the least worst-case error.",
                                   {0.2, 1}},
                                  fit_published_tests);
}
