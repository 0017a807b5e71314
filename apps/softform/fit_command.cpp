// softform fit: material parameters from rubber tests, by several solvers, with what they are worth.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>

#include <fmt/format.h>
#include <glog/logging.h>
#include <spdlog/spdlog.h>

#include "commands.hpp"
#include "files.hpp"
#include "fit_results.hpp"
#include "progress.hpp"
#include "softform/core/error.hpp"
#include "softform/core/interrupt.hpp"
#include "softform/io/text_file.hpp"
#include "softform/materials/material_file.hpp"

namespace softform::cli {
namespace {

constexpr const char* examples = R"(Examples:
  softform fit --uniaxial tension.csv --equibiaxial bulge.csv --model hart_smith --solver ceres --out rubber
  softform fit --uniaxial u.csv --pure-shear s.csv --inflation sheet.csv --model all --solver all --out rubber
  softform inflate bunny.off --material rubber/material.json --thickness 0.3mm --volume-ratio 5 --out inflated
A test is plain CSV, one row a point, the stretch increasing; lines that start with # are comments:
  stretch,nominal_stress_mpa                 uniaxial, equibiaxial, pure shear
  stretch_1,stretch_2,nominal_stress_1_mpa,nominal_stress_2_mpa            biaxial
  pressure_mmhg,pole_radius_cm,stretch       inflation of a clamped sheet, with a line '# thickness: 0.5 mm' above
Stretch is deformed over undeformed length (1 at rest), nominal stress is force per undeformed area. Other units by the
column's name: _pa, _kpa, _mpa, _kgf_cm2. True stress only as true_stress_mpa and so on.
Give at least two modes where you can: one alone does not determine a model of two parameters or more.
Writes into DIR:
  material.json     what inflate and balloon take: the best model by --weights; for all also material_MODEL.json
  parameters.csv    model,solver,parameter,value,standard_error,unit (SI)
  residuals.csv     every measured stress beside the fitted one
  prediction.csv    fitted on one test alone, how well is each of the others predicted? Empty
                    where that test has too few points; by gauss_newton with --solver all
  trust.json        every minimum found, correlations, condition number, stability, warnings
  fit.png           measured points and the models' curves
Models: st_venant_kirchhoff, neo_hookean, mooney_rivlin, ogden, hart_smith.)";

struct FitInput {
  std::map<TestMode, std::string> files;
  std::string model, solver = "all", weights = "absolute", out;
  FitOptions options;
};

std::vector<RubberTest> read_tests(const FitInput& input)
{
  std::vector<RubberTest> tests;
  for (const auto& [mode, file] : input.files) tests.push_back(read_rubber_test(file, mode));
  if (tests.empty())
    throw InputError(
        "there is nothing to fit: give a test with --uniaxial, --equibiaxial, --pure-shear, --biaxial or "
        "--inflation");
  return tests;
}

std::vector<std::string> chosen_solvers(const std::string& name)
{
  if (name != "all") return {find_least_squares_solver(name).name};
  std::vector<std::string> names;
  for (const LeastSquaresSolver& solver : least_squares_solvers()) names.push_back(solver.name);
  return names;
}

/// The models asked for that the data can determine; of `all`, those that cannot be are left out and said so.
std::vector<std::string> chosen_models(const FitInput& input, const std::vector<RubberTest>& tests)
{
  std::vector<std::string> names;
  if (input.model != "all") {
    StressFit(find_material_model(input.model), tests, input.options.weights, input.options.terms);
    return {input.model};
  }
  for (const MaterialModel& model : material_models()) {
    try {
      StressFit(model, tests, input.options.weights, input.options.terms);
      names.push_back(model.name);
    } catch (const InputError& error) {
      spdlog::warn("left out: {}", error.what());
    }
  }
  return names;
}

FitResult fit_one(const std::string& model, const std::vector<RubberTest>& tests, const FitOptions& options,
                  Progress& progress)
{
  progress.step(fmt::format("{} by {}", model, options.solver));
  const auto show = [](int, int) { return !interrupted(); };
  FitResult result{fit_material(model, tests, options, show), {}, {}, {}, {}};
  if (!result.fit.material) return result;  // interrupted before the first start ended
  const StressFit problem(find_material_model(model), tests, options.weights, options.terms);
  result.uncertainty = uncertainty(problem, result.fit.z);
  result.error = stress_error(*result.fit.material, tests);
  result.instabilities = find_instabilities(*result.fit.material, tests);
  result.warnings = warnings(result.fit, result.uncertainty, result.instabilities, tests);
  return result;
}

std::string source_of(const FitResult& best, const std::vector<RubberTest>& tests, const std::string& reason)
{
  std::string files;
  for (const RubberTest& test : tests) {
    files += files.empty() ? "" : "; ";
    files +=
        fmt::format("{} ({}){}", test.name, to_string(test.mode), test.citation.empty() ? "" : ": " + test.citation);
  }
  return fmt::format("softform fit by {}, rms {:.4g} Pa, mean relative error {:.3g}{}, on {}", best.fit.solver,
                     best.error.rms, best.error.mean_relative, reason, files);
}

/// A minimum before an end that is none, then the lower cost.
bool is_better(const MaterialFit& a, const MaterialFit& b)
{
  return a.minima.empty() == b.minima.empty() ? a.cost < b.cost : b.minima.empty();
}

/// The best solver's result of each model.
std::vector<const FitResult*> best_of_models(const std::vector<FitResult>& results)
{
  std::vector<const FitResult*> best;
  for (const FitResult& result : results) {
    if (best.empty() || best.back()->model() != result.model())
      best.push_back(&result);
    else if (is_better(result.fit, best.back()->fit))
      best.back() = &result;
  }
  return best;
}

/// The chosen one is that of least cost: what --weights asks for.
void write_materials(const std::filesystem::path& out, const std::vector<const FitResult*>& best,
                     const std::vector<RubberTest>& tests, Weights weights)
{
  const FitResult& chosen =
      **std::min_element(best.begin(), best.end(), [](auto* a, auto* b) { return a->fit.cost < b->fit.cost; });
  std::string reason;
  if (best.size() > 1) {
    reason = fmt::format(", the least rms{} of {} models", weights == Weights::Relative ? " of relative errors" : "",
                         best.size());
    for (const FitResult* result : best)
      write_material(out / fmt::format("material_{}.json", result->model()), *result->fit.material,
                     source_of(*result, tests, ""));
  }
  write_material(out / "material.json", *chosen.fit.material, source_of(chosen, tests, reason));
  spdlog::info("material.json is {}: rms {:.4g} Pa with {} parameters{}", chosen.model(), chosen.error.rms,
               chosen.fit.material->parameters().size(), reason);
}

void report(const FitResult& result)
{
  std::string values;
  for (const auto& [name, value, unit] : result.fit.material->parameters())
    values += fmt::format(" {} = {:.5g}{}", name, value, unit == "1" ? "" : " " + unit);
  spdlog::info("{} by {}:{}, rms {:.4g} Pa, cost {:.9g}", result.model(), result.fit.solver, values, result.error.rms,
               result.fit.cost);
}

ExitCode write_results(const FitInput& input, const std::vector<FitResult>& results,
                       const std::vector<RubberTest>& tests, Progress& progress)
{
  const auto best = best_of_models(results);
  std::vector<ModelPredictions> predictions;
  for (const FitResult* result : best) {
    if (interrupted()) break;
    progress.step(fmt::format("predictions of {}", result->model()));
    FitOptions options = input.options;
    options.solver = input.solver == "all" ? "gauss_newton" : input.solver;  // the quickest of all
    predictions.push_back({result->model(), cross_prediction(result->model(), tests, options)});
    for (const auto& [fitted_on, predicted, error] : predictions.back().matrix)
      if (fitted_on == predicted && !std::isfinite(error.rms))
        spdlog::warn("{}: no predictions from {} alone: it has too few points", result->model(), fitted_on);
  }
  progress.end();
  const std::filesystem::path out(input.out);
  write_materials(out, best, tests, input.options.weights);  // first: what the user came for
  write_text(out / "parameters.csv", parameters_csv(results));
  write_text(out / "residuals.csv", residuals_csv(results, tests));
  write_text(out / "prediction.csv", prediction_csv(predictions));
  write_text(out / "trust.json", trust_json(results));
  draw_fit(out / "fit.png", best, tests);
  for (const FitResult& result : results) report(result);
  bool is_complete = true;
  for (const FitResult* result : best) {
    if (result->instabilities.empty())
      spdlog::info("{}: stable by Drucker's and by Baker and Ericksen's criterion over the range of the data",
                   result->model());
    for (const std::string& warning : result->warnings) spdlog::warn("{}: {}", result->model(), warning);
    is_complete = is_complete && !result->fit.minima.empty();
  }
  if (interrupted()) {
    spdlog::warn("interrupted: what was fitted so far is in {}", input.out);
    return Interrupted;
  }
  return is_complete ? Success : NotReached;
}

ExitCode run(FitInput input)
{
  input.options.weights = input.weights == "relative" ? Weights::Relative : Weights::Absolute;
  require_writable(input.out);
  const std::vector<RubberTest> tests = read_tests(input);
  const std::vector<std::string> solvers = chosen_solvers(input.solver);
  const std::vector<std::string> models = chosen_models(input, tests);
  if (models.empty()) throw InputError("there are too few points for any model: measure more");

  catch_interrupts();
  FLAGS_minloglevel = google::GLOG_FATAL;  // Ceres reports every trial step that it cannot evaluate
  Progress progress;
  std::vector<FitResult> results;
  for (const std::string& model : models) {
    for (const std::string& solver : solvers) {
      if (interrupted()) break;
      FitOptions options = input.options;
      options.solver = solver;
      FitResult result = fit_one(model, tests, options, progress);
      if (result.fit.material) results.push_back(std::move(result));
    }
  }
  if (results.empty()) {
    spdlog::warn("{}: nothing was written", interrupted() ? "interrupted before the first fit ended" : "no fit ended");
    return interrupted() ? Interrupted : NotReached;
  }
  return write_results(input, results, tests, progress);
}

}  // namespace

void add_fit_command(CLI::App& program, ExitCode& exit_code)
{
  CLI::App* command = program.add_subcommand("fit", "Fit a material's parameters to rubber tests");
  auto input = std::make_shared<FitInput>();
  const auto add_test = [&](const std::string& name, TestMode mode, const std::string& help) {
    command
        ->add_option_function<std::string>(
            name, [input, mode](const std::string& file) { input->files[mode] = file; }, help)
        ->type_name("FILE");
  };
  add_test("--uniaxial", TestMode::Uniaxial, "Tension or compression along one axis");
  add_test("--equibiaxial", TestMode::Equibiaxial, "Equal stretch along two axes");
  add_test("--pure-shear", TestMode::PureShear, "Tension of a strip too wide to contract");
  add_test("--biaxial", TestMode::Biaxial, "Two stretches, independent of each other");
  add_test("--inflation", TestMode::Inflation, "A clamped sheet inflated, seen at its pole");
  command->add_option("--model", input->model, "A material model, or all")->required()->type_name("NAME|all");
  command->add_option("--solver", input->solver, "ceres, nlopt, gauss_newton or all [all]")->type_name("NAME|all");
  command
      ->add_option("--weights", input->weights, "absolute: large stresses decide; relative: all count alike [absolute]")
      ->check(CLI::IsMember({"absolute", "relative"}));
  command->add_option("--terms", input->options.terms, "Terms of Ogden's sum [2]")->check(CLI::Range(1, 4));
  command->add_option("--starts", input->options.starts, "Random starts of each solver [12]")
      ->check(CLI::Range(1, 1000));
  command->add_option("--seed", input->options.seed, "Of the random starts [1]");
  command->add_option("--out", input->out, "Folder for the results; created if need be")->required()->type_name("DIR");
  command->footer(examples);
  command->callback([input, &exit_code] { exit_code = run(*input); });
}

}  // namespace softform::cli
