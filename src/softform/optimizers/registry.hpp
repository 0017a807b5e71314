#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "softform/optimizers/optimizer.hpp"

namespace softform {

/// A method as the registry knows it.
struct OptimizerEntry {
  std::string name;                                  ///< "reduced_gauss_newton"
  std::string summary;                               ///< one line for tables and --help
  bool takes_constraints = false;                    ///< c(z) = 0
  bool takes_bounds = false;                         ///< lower <= z <= upper
  std::function<std::unique_ptr<Optimizer>()> make;  ///< with its default options
  bool needs_restoration = false;                    ///< only programmes whose restore() finds feasible points
  bool needs_residuals = false;                      ///< only a LeastSquaresProgram
};

/// Every method, in the order of the tables. One line each in registry.cpp.
const std::vector<OptimizerEntry>& optimizers();

/// Throws InputError that lists the known names.
std::unique_ptr<Optimizer> make_optimizer(const std::string& name);

}  // namespace softform
