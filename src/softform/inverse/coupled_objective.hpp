#pragma once

#include "softform/core/types.hpp"

namespace softform {

/// A dimensionless function of a state x and a design p together, z = (x, p).
class CoupledObjective {
 public:
  virtual ~CoupledObjective() = default;

  /// +infinity where it is not defined.
  virtual double value(ConstVec x, ConstVec p) = 0;
  /// (z).
  virtual Vec gradient(ConstVec x, ConstVec p) = 0;
  /// U (z, k): U U^t is a positive semi-definite model of its Hessian, of low rank.
  virtual Eigen::MatrixXd curvature_factors(ConstVec x, ConstVec p) = 0;
  /// Factorisations made for it so far.
  virtual int linear_solves() const = 0;
};

}  // namespace softform
