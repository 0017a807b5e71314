#include "fit_results.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "plot.hpp"

namespace softform::cli {
namespace {

/// An empty field where there is no number.
std::string number(double value) { return std::isfinite(value) ? fmt::format("{}", value) : ""; }

/// JSON knows no NaN: null.
nlohmann::ordered_json json_number(double value)
{
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json();
}

}  // namespace

std::string parameters_csv(const std::vector<FitResult>& results)
{
  std::string text = "model,solver,parameter,value,standard_error,unit\n";
  for (const FitResult& result : results) {
    std::size_t j = 0;
    for (const auto& [name, value, unit] : result.fit.material->parameters())
      text += fmt::format("{},{},{},{},{},{}\n", result.model(), result.fit.solver, name, value,
                          number(result.uncertainty.standard_errors[j++]), unit);
  }
  return text;
}

std::string residuals_csv(const std::vector<FitResult>& results, const std::vector<RubberTest>& tests)
{
  std::string text = "model,solver,mode,line,stretch_1,stretch_2,direction,measured [Pa],fitted [Pa],residual [Pa]\n";
  for (const FitResult& result : results) {
    for (const RubberTest& test : tests) {
      for (const auto& [stretches, direction, measured, line] : test.observations) {
        const double fitted = nominal_stress(*result.fit.material, stretches)[direction];
        text += fmt::format("{},{},{},{},{},{},{},{},{},{}\n", result.model(), result.fit.solver, to_string(test.mode),
                            line, stretches[0], stretches[1], direction + 1, measured, fitted, fitted - measured);
      }
    }
  }
  return text;
}

std::string prediction_csv(const std::vector<ModelPredictions>& predictions)
{
  std::string text = "model,fitted_on,predicted,rms [Pa],mean_relative_error\n";
  for (const auto& [model, matrix] : predictions)
    for (const auto& [fitted_on, predicted, error] : matrix)
      text +=
          fmt::format("{},{},{},{},{}\n", model, fitted_on, predicted, number(error.rms), number(error.mean_relative));
  return text;
}

std::string trust_json(const std::vector<FitResult>& results)
{
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const FitResult& result : results) {
    nlohmann::ordered_json entry;
    entry["model"] = result.model();
    entry["solver"] = result.fit.solver;
    entry["outcome"] = result.fit.report.message;
    entry["cost"] = result.fit.cost;
    entry["rms [Pa]"] = result.error.rms;
    entry["mean_relative_error"] = result.error.mean_relative;
    entry["condition_number"] = json_number(result.uncertainty.condition_number);
    for (const auto& row : result.uncertainty.correlation.rowwise()) {
      nlohmann::ordered_json line;
      for (const double value : row) line.push_back(json_number(value));
      entry["correlation"].push_back(line);
    }
    for (const LocalMinimum& minimum : result.fit.minima) {
      nlohmann::ordered_json found{{"cost", minimum.cost}, {"starts", minimum.starts}};
      for (const auto& [name, value, unit] : minimum.parameters) found["parameters"][name] = value;
      entry["minima"].push_back(found);
    }
    entry["unfinished_starts"] = result.fit.unfinished_starts;
    entry["is_stable_over_data"] = result.instabilities.empty();
    for (const auto& [mode, criterion, stretch] : result.instabilities)
      entry["instabilities"].push_back({{"mode", to_string(mode)}, {"criterion", criterion}, {"stretch", stretch}});
    entry["warnings"] = result.warnings;
    json.push_back(entry);
  }
  return json.dump(2) + "\n";
}

namespace {

Series fitted_curve(const Material& material, TestMode mode, double low, double high)
{
  constexpr int samples = 200;
  Series curve{material.model(), {}, Mark::Line};
  for (int k = 0; k <= samples; ++k) {
    const double stretch = low + (high - low) * k / samples;
    curve.points.push_back({stretch, 1e-6 * nominal_stress(material, stretches_of(mode, stretch))[0]});
  }
  return curve;
}

/// A biaxial test has no single curve: the fitted stress where there is a measured one.
Series fitted_points(const Material& material, const RubberTest& test)
{
  Series points{material.model(), {}, Mark::Cross};
  for (const auto& [stretches, direction, measured, line] : test.observations)
    points.points.push_back({stretches[direction], 1e-6 * nominal_stress(material, stretches)[direction]});
  return points;
}

}  // namespace

void draw_fit(const std::filesystem::path& png, const std::vector<const FitResult*>& best_of_models,
              const std::vector<RubberTest>& tests)
{
  std::vector<Panel> panels;
  for (const RubberTest& test : tests) {
    Panel panel{test.name, "stretch [1]", "nominal stress [MPa]", {}};
    Series measured{"measured", {}, Mark::Dot};
    double low = 1, high = 1;
    for (const StressObservation& observation : test.observations) {
      const double stretch = observation.stretches[observation.direction];
      measured.points.push_back({stretch, 1e-6 * observation.stress});
      low = std::min(low, stretch);
      high = std::max(high, stretch);
    }
    for (const FitResult* result : best_of_models) {
      const Material& material = *result->fit.material;
      panel.series.push_back(test.mode == TestMode::Biaxial ? fitted_points(material, test)
                                                            : fitted_curve(material, test.mode, low, high));
    }
    panel.series.push_back(measured);
    panels.push_back(panel);
  }
  draw_panels(png, panels);
}

}  // namespace softform::cli
