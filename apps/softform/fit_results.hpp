#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "softform/fitting/trust.hpp"

namespace softform::cli {

/// One model fitted by one solver, with what was found out about it.
struct FitResult {
  MaterialFit fit;
  Uncertainty uncertainty;
  StressError error;
  std::vector<Instability> instabilities;
  std::vector<std::string> warnings;

  std::string model() const { return fit.material->model(); }
};

/// The matrix of predictions of a model.
struct ModelPredictions {
  std::string model;
  std::vector<Prediction> matrix;
};

/// parameters.csv: model,solver,parameter,value,standard_error,unit.
std::string parameters_csv(const std::vector<FitResult>& results);
/// residuals.csv: every measured stress beside the fitted one [Pa].
std::string residuals_csv(const std::vector<FitResult>& results, const std::vector<RubberTest>& tests);
/// prediction.csv: fitted on one test (or all), predicted on each.
std::string prediction_csv(const std::vector<ModelPredictions>& predictions);
/// trust.json: errors, every minimum, correlations, condition number, warnings.
std::string trust_json(const std::vector<FitResult>& results);

/// fit.png: a panel a test, the measured stresses and each model's curve.
void draw_fit(const std::filesystem::path& png, const std::vector<const FitResult*>& best_of_models,
              const std::vector<RubberTest>& tests);

}  // namespace softform::cli
