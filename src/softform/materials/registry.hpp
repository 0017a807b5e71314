#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "softform/materials/material_model.hpp"

namespace softform {

/// Every material model, in the order of the thesis' appendix A.
const std::vector<MaterialModel>& material_models();

/// The model of that name. Throws InputError listing the known ones.
const MaterialModel& find_material_model(const std::string& name);

/// The names and units of a model's parameters, given how many were supplied (which matters to sums only).
std::vector<MaterialModel::Parameter> expected_parameters(const MaterialModel& model, std::size_t supplied);

/// A material from its parameters by name, in SI units. Throws InputError for an unknown model, a missing, unknown or
/// non-finite parameter, or a value that the model cannot have.
std::unique_ptr<Material> make_material(const std::string& model, const std::map<std::string, double>& parameters);

}  // namespace softform
