#pragma once

#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "softform/core/dual.hpp"
#include "softform/materials/material.hpp"

namespace softform {

/// The values that a parameter can have, for those who search them.
enum class Range { Positive, NonNegative, Real };

/// A material model in the registry: what it is called, what it asks for, how it is made.
struct MaterialModel {
  struct Parameter {
    std::string name;
    std::string unit;  ///< "Pa" or "1"
    Range range = Range::Positive;
    /// Where the range starts from a multiple of another parameter instead of zero: that one's index and the factor.
    int base = -1;
    double base_factor = 0;
  };

  std::string name;
  std::vector<Parameter> parameters;
  /// The parameters come once a term of a sum, numbered from 1: mu_1, alpha_1, mu_2, ...
  bool is_sum = false;
  /// A material from all its parameters, in order and in SI units.
  /// Throws InputError naming the parameter that the model cannot have.
  std::unique_ptr<Material> (*make)(const std::string& model, std::vector<MaterialParameter> parameters);
  /// Psi(t, d) at these parameters, bare of any check, and with derivatives by them: what a fit evaluates.
  BasicMembraneDensity<double> (*density)(const std::vector<double>& parameters, double t, double d, Order order);
  BasicMembraneDensity<Dual> (*dual_density)(const std::vector<Dual>& parameters, double t, double d, Order order);
};

/// The interface `Material` on a formula `Model<Scalar>`, which has
///     static Model from(std::vector<Scalar>)          its parameters in order density(t, d, order), shear_modulus()
/// and a free function check_parameters(Model<double>) that throws InputError.
template <template <class> class Model>
class MaterialOf final : public Material {
 public:
  MaterialOf(std::string model, std::vector<MaterialParameter> parameters)
      : model_(std::move(model)), parameters_(std::move(parameters)), formula_(Model<double>::from(values(parameters_)))
  {
    check_parameters(formula_);
  }

  std::string model() const override { return model_; }
  std::vector<MaterialParameter> parameters() const override { return parameters_; }
  double shear_modulus() const override { return formula_.shear_modulus(); }

  MembraneDensity density(double t, double d, Order order) const override
  {
    if (is_inside(t, d)) {
      const MembraneDensity density = formula_.density(t, d, order);
      if (std::isfinite(density.psi)) return density;
    }
    MembraneDensity outside;
    outside.psi = std::numeric_limits<double>::infinity();
    return outside;
  }

  MembraneDensity density_derivative(int parameter, double t, double d, Order order) const override
  {
    if (!is_inside(t, d)) return {};
    const std::vector<double> numbers = values(parameters_);
    std::vector<Dual> duals(numbers.begin(), numbers.end());
    Dual& variable = duals.at(static_cast<std::size_t>(parameter));
    variable = Dual::variable(variable.value(), 0);
    const BasicMembraneDensity<Dual> f = Model<Dual>::from(duals).density(t, d, order);
    const auto by_variable = [](const Dual& x) { return x.derivative(0); };
    return {by_variable(f.psi),     by_variable(f.psi_t),  by_variable(f.psi_d),   by_variable(f.psi_tt),
            by_variable(f.psi_td),  by_variable(f.psi_dd), by_variable(f.psi_ttt), by_variable(f.psi_ttd),
            by_variable(f.psi_tdd), by_variable(f.psi_ddd)};
  }

 private:
  static bool is_inside(double t, double d)
  {
    constexpr double round_off = 1e-9;
    return d > 0 && t >= 2 * std::sqrt(d) * (1 - round_off);
  }

  static std::vector<double> values(const std::vector<MaterialParameter>& parameters)
  {
    std::vector<double> numbers;
    numbers.reserve(parameters.size());
    for (const MaterialParameter& parameter : parameters) numbers.push_back(parameter.value);
    return numbers;
  }

  std::string model_;
  std::vector<MaterialParameter> parameters_;
  Model<double> formula_;
};

template <template <class> class Model>
std::unique_ptr<Material> make_material_of(const std::string& model, std::vector<MaterialParameter> parameters)
{
  return std::make_unique<MaterialOf<Model>>(model, std::move(parameters));
}

template <template <class> class Model, class Scalar>
BasicMembraneDensity<Scalar> density_of(const std::vector<Scalar>& parameters, double t, double d, Order order)
{
  return Model<Scalar>::from(parameters).density(t, d, order);
}

/// The registry's entry of a formula.
template <template <class> class Model>
MaterialModel material_model_of(const std::string& name, const std::vector<MaterialModel::Parameter>& parameters,
                                bool is_sum = false)
{
  return {name, parameters, is_sum, make_material_of<Model>, density_of<Model, double>, density_of<Model, Dual>};
}

}  // namespace softform
