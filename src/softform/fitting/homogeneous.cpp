#include "softform/fitting/homogeneous.hpp"

#include <cmath>
#include <limits>

namespace softform {
namespace {

double trace(const Stretches& l) { return l.square().sum(); }
double determinant(const Stretches& l) { return l.square().prod(); }

/// P_i = 2 l_i (a + b l_j^2) with a = Psi_t and b = Psi_d, or with their derivatives by a parameter.
Eigen::Array2d stress(double a, double b, const Stretches& l) { return 2 * l * (a + b * l.reverse().square()); }

}  // namespace

Eigen::Array2d nominal_stress(const Material& material, const Stretches& stretches)
{
  const MembraneDensity density = material.density(trace(stretches), determinant(stretches), Order::Gradient);
  if (!std::isfinite(density.psi)) return Eigen::Array2d::Constant(std::numeric_limits<double>::quiet_NaN());
  return stress(density.psi_t, density.psi_d, stretches);
}

Eigen::Array2d nominal_stress(const MaterialModel& model, const std::vector<double>& parameters,
                              const Stretches& stretches)
{
  const MembraneDensity density = model.density(parameters, trace(stretches), determinant(stretches), Order::Gradient);
  return stress(density.psi_t, density.psi_d, stretches);
}

StressByParameters stress_by_parameters(const MaterialModel& model, const std::vector<double>& parameters,
                                        const Stretches& stretches)
{
  std::vector<Dual> variables;
  for (const double parameter : parameters)
    variables.push_back(Dual::variable(parameter, static_cast<int>(variables.size())));
  const auto density = model.dual_density(variables, trace(stretches), determinant(stretches), Order::Gradient);
  StressByParameters result;
  result.stress = stress(density.psi_t.value(), density.psi_d.value(), stretches);
  const auto n = static_cast<int>(parameters.size());
  result.by_parameters.resize(2, n);
  for (int i = 0; i < n; ++i)
    result.by_parameters.col(i) = stress(density.psi_t.derivative(i), density.psi_d.derivative(i), stretches);
  return result;
}

Eigen::Matrix2d logarithmic_stiffness(const Material& material, const Stretches& stretches)
{
  const Eigen::Array2d s = stretches.square();  // d/d(ln l_i) = 2 s_i d/ds_i, with t = s_1 + s_2 and d = s_1 s_2
  const double d = s.prod();
  const MembraneDensity w = material.density(s.sum(), d, Order::Hessian);
  if (!std::isfinite(w.psi)) return Eigen::Matrix2d::Constant(std::numeric_limits<double>::quiet_NaN());
  Eigen::Matrix2d H;
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; j < 2; ++j)
      H(i, j) = 4 * (w.psi_tt * s[i] * s[j] + w.psi_td * d * (s[i] + s[j]) + w.psi_dd * d * d + w.psi_d * d);
    H(i, i) += 4 * w.psi_t * s[i];
  }
  return H;
}

double pole_pressure(const Material& material, double thickness, double radius, double stretch)
{
  return 2 * thickness / (radius * stretch) * nominal_stress(material, {stretch, stretch})[0];
}

double pole_stress(double pressure, double thickness, double radius, double stretch)
{
  return pressure * radius * stretch / (2 * thickness);
}

}  // namespace softform
