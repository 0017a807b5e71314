#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "softform/materials/registry.hpp"

namespace softform::testing {

/// The names of all registered models: tests loop over them, so a new model is tested as soon as it is registered.
inline std::vector<std::string> model_names()
{
  std::vector<std::string> names;
  for (const MaterialModel& model : material_models()) names.push_back(model.name);
  return names;
}

/// A material of that model with parameters of the size that rubber has: moduli of 0.2 MPa and more, dimensionless
/// numbers near 0.05; a sum has two terms.
inline std::unique_ptr<Material> example_of(const std::string& name)
{
  const MaterialModel& model = find_material_model(name);
  std::map<std::string, double> parameters;
  double k = 0;
  for (const auto& parameter : expected_parameters(model, 2 * model.parameters.size())) {
    parameters[parameter.name] =
        parameter.unit == "Pa" ? 0.2e6 * (1 + 0.5 * k) : (model.is_sum ? 2.6 - 1.7 * k : 0.04 * k);
    ++k;
  }
  return make_material(name, parameters);
}

/// W(lambda_1, lambda_2): the energy of a sheet stretched along two axes [Pa].
inline double energy(const Material& material, double l1, double l2)
{
  return material.density(l1 * l1 + l2 * l2, l1 * l1 * l2 * l2, Order::Value).psi;
}

}  // namespace softform::testing
