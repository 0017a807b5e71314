#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "softform/fitting/homogeneous.hpp"
#include "softform/fitting/least_squares.hpp"
#include "softform/fitting/rubber_test.hpp"
#include "softform/materials/registry.hpp"

namespace softform {

/// A residual is the error of the nominal stress over the rms of all measured stresses, or over the measured stress
/// itself. The first lets large stretches decide, the second treats all alike; a measured zero then counts nothing.
enum class Weights { Absolute, Relative };

/// The stresses of homogeneous tests as a function of a model's parameters p, seen through free variables z:
///     p_j = b_j + s_j exp(z_j)   where the model asks for p_j > b_j or p_j >= b_j,   p_j = z_j elsewhere,
/// so that every z is admissible. b_j is 0 or a multiple of another parameter, s_j the size of the stresses for moduli
/// and 1 for numbers.
class StressFit final : public LeastSquaresProblem {
 public:
  /// `terms` is for sums (Ogden). Throws InputError where there is nothing to fit, not more informative observations
  /// than parameters, or more parameters than Dual::variables.
  StressFit(const MaterialModel& model, const std::vector<RubberTest>& tests, Weights weights, int terms);

  int parameter_count() const override { return static_cast<int>(parameters_.size()); }
  int residual_count() const override { return static_cast<int>(observations_.size()); }
  bool evaluate(ConstVec z, Vec& residuals, Eigen::MatrixXd* jacobian) const override;
  Vec scale(ConstVec z) const override { return Vec::Ones(z.size()); }
  /// The residuals that depend on the parameters: not those at rest, nor those of no weight.
  int informative_count() const;

  /// p(z), in SI units and the model's order, and dp/dz (n, n).
  std::vector<double> parameters_at(ConstVec z) const;
  Eigen::MatrixXd parameter_jacobian(ConstVec z) const;
  /// The same by name; one that may be zero and that the data cannot tell from it is zero.
  std::vector<MaterialParameter> named_parameters(ConstVec z) const;

  /// The box (n) that starting points are drawn from: rubber-like moduli around the stresses, and numbers.
  Vec lower_start() const;
  Vec upper_start() const;

  const std::vector<MaterialModel::Parameter>& parameters() const { return parameters_; }
  /// True where p_j is so close to the end of its range that the data cannot tell it from there.
  std::vector<bool> at_bound(ConstVec z) const;
  /// True where the cost is stationary in every p_j inside its range and does not fall away from those at its end.
  bool is_minimum(ConstVec z) const;
  /// The same material with the terms of a sum in a fixed order, the largest modulus first.
  Vec ordered(ConstVec z) const;

 private:
  /// Weighted residuals and their derivatives by the parameters themselves.
  bool evaluate_at(const std::vector<double>& p, Vec& residuals, Eigen::MatrixXd* jacobian) const;
  bool is_free(int j) const { return parameters_[std::size_t(j)].range == Range::Real; }
  double stress_size() const;

  const MaterialModel& model_;
  std::vector<MaterialModel::Parameter> parameters_;
  std::vector<StressObservation> observations_;
  Vec weights_;  ///< (m) [1/Pa]
  Vec sizes_;    ///< (n) s_j
};

struct FitOptions {
  std::string solver = "ceres";
  Weights weights = Weights::Absolute;
  int terms = 2;      ///< of a sum: Ogden's four parameters
  int starts = 12;    ///< drawn at random; more find more of the minima
  unsigned seed = 1;  ///< the same starts for every solver
};

/// A minimum that some starts ended in.
struct LocalMinimum {
  Vec z;
  double cost = 0;
  int starts = 0;  ///< how many ended here
  std::vector<MaterialParameter> parameters;
};

/// What came out for one model, one solver.
struct MaterialFit {
  /// At the best minimum; where no start ended in one, at the least cost; null where no cost was finite.
  std::shared_ptr<const Material> material;
  std::string solver;
  double cost = std::numeric_limits<double>::infinity();             ///< 1/2 sum of the squared weighted residuals
  std::vector<LocalMinimum> minima;                                  ///< distinct ones, the best first
  int unfinished_starts = 0;                                         ///< starts that did not end in a minimum
  double unfinished_cost = std::numeric_limits<double>::infinity();  ///< the least of theirs
  Report report;                                                     ///< of the best start
  Vec z;
};

/// Called before each start; returning false ends the fit with what it has.
using FitObserver = std::function<bool(int start, int starts)>;

/// The best of several starts and every distinct minimum seen. Two ends are the same minimum when their residuals are:
/// parameters that the data cannot tell apart, or terms of a sum in another order, do not make two of it.
MaterialFit fit_material(const std::string& model, const std::vector<RubberTest>& tests, const FitOptions& options,
                         const FitObserver& observer = {});

/// How well a material meets tests: root mean square error of the nominal stress [Pa], and the mean of the error over
/// the measured stress where that is not zero [1].
struct StressError {
  double rms = 0;
  double mean_relative = 0;
};
StressError stress_error(const Material& material, const std::vector<RubberTest>& tests);

}  // namespace softform
