#include "softform/materials/registry.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "softform/core/error.hpp"
#include "softform/materials/hart_smith.hpp"
#include "softform/materials/mooney_rivlin.hpp"
#include "softform/materials/neo_hookean.hpp"
#include "softform/materials/ogden.hpp"
#include "softform/materials/st_venant_kirchhoff.hpp"

namespace softform {

const std::vector<MaterialModel>& material_models()
{
  static const std::vector<MaterialModel> models{
      st_venant_kirchhoff_model(),  // A.3
      neo_hookean_model(),          // A.4
      mooney_rivlin_model(),        // A.5
      ogden_model(),                // A.6
      hart_smith_model(),           // A.7
  };
  return models;
}

const MaterialModel& find_material_model(const std::string& name)
{
  std::string known;
  for (const MaterialModel& model : material_models()) {
    if (model.name == name) return model;
    known += (known.empty() ? "" : ", ") + model.name;
  }
  throw InputError(fmt::format("unknown material model '{}': use one of {}", name, known));
}

std::vector<MaterialModel::Parameter> expected_parameters(const MaterialModel& model, std::size_t supplied)
{
  if (!model.is_sum) return model.parameters;
  const std::size_t size = model.parameters.size();
  const std::size_t terms = std::max<std::size_t>(1, (supplied + size - 1) / size);
  std::vector<MaterialModel::Parameter> expected;
  for (std::size_t j = 1; j <= terms; ++j)
    for (MaterialModel::Parameter parameter : model.parameters) {
      parameter.name = fmt::format("{}_{}", parameter.name, j);
      expected.push_back(parameter);
    }
  return expected;
}

std::unique_ptr<Material> make_material(const std::string& name, const std::map<std::string, double>& parameters)
{
  const MaterialModel& model = find_material_model(name);
  std::vector<MaterialParameter> ordered;
  std::string names;
  for (const auto& expected : expected_parameters(model, parameters.size())) {
    const auto given = parameters.find(expected.name);
    if (given == parameters.end())
      throw InputError(fmt::format("{}: the parameter '{}' is missing: add it", name, expected.name));
    if (!std::isfinite(given->second))
      throw InputError(fmt::format("{}: {} = {} is not a finite number", name, expected.name, given->second));
    ordered.push_back({expected.name, given->second, expected.unit});
    names += (names.empty() ? "" : ", ") + expected.name;
  }
  for (const auto& [given, value] : parameters) {
    const auto is_given = [&given = given](const MaterialParameter& parameter) { return parameter.name == given; };
    if (std::none_of(ordered.begin(), ordered.end(), is_given))
      throw InputError(fmt::format("{}: unknown parameter '{}': it has {}", name, given, names));
  }
  return model.make(name, std::move(ordered));
}

}  // namespace softform
