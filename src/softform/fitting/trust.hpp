#pragma once

#include <optional>
#include <string>
#include <vector>

#include "softform/fitting/parameter_fit.hpp"

namespace softform {

/// How far the data determine the parameters of a fit.
struct Uncertainty {
  std::vector<double> standard_errors;  ///< in the parameters' units; NaN for one at the end of its range
  Eigen::MatrixXd correlation;          ///< (n, n); NaN rows and columns for those at the end of their range
  /// Of the Jacobian in relative parameters; infinite where it is rank-deficient.
  double condition_number = 0;
};

/// Standard errors and correlations sigma^2 (J^T J)^-1, sigma^2 = |r|^2/(m - n), m the informative residuals, from
/// Ceres' covariance, taken from the free variables to the parameters by the chain rule. Parameters at the end of their
/// range are held. They hold for random errors of the stress; a model that does not follow the data is a systematic
/// one.
Uncertainty uncertainty(const StressFit& problem, ConstVec z);

/// A stretch at which a material stops to be stable in a mode.
struct Instability {
  TestMode mode;
  std::string criterion;  ///< "Drucker" or "Baker-Ericksen"
  double stretch;
};

/// The first violations, in uniaxial, equibiaxial and pure shear, from rest out to the data's largest first invariant,
/// and in compression where the data go there. Drucker: the work of stress increments on logarithmic strain increments
/// is positive. Baker-Ericksen: the larger stretch has the larger true stress.
std::vector<Instability> find_instabilities(const Material& material, const std::vector<RubberTest>& tests);

/// Fits on one test alone, and on all; each evaluated on every test.
struct Prediction {
  std::string fitted_on;  ///< a mode, or "all"
  std::string predicted;  ///< a mode
  StressError error;
};

/// What a user must know before relying on the parameters, in plain words: parameters that are not identifiable from
/// these modes, at the end of their range or unlike rubber, other minima as good, an unstable material, a model that
/// does not follow the data.
std::vector<std::string> warnings(const MaterialFit& fit, const Uncertainty& uncertainty,
                                  const std::vector<Instability>& instabilities, const std::vector<RubberTest>& tests);

/// The matrix of predictions of a model. A test with too few points for the model gives a row of NaN.
/// Throws InputError where `model` or the options are not known.
std::vector<Prediction> cross_prediction(const std::string& model, const std::vector<RubberTest>& tests,
                                         const FitOptions& options);

}  // namespace softform
