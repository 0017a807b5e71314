#include "softform/materials/barrier_tension_field.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>
#include <fmt/format.h>

#include "softform/core/error.hpp"
#include "softform/materials/strain_formula.hpp"

namespace softform {
namespace {

// What belongs to a natural stretch M = C~ + W of the material, given by trace a and determinant b of M - 1:
//     N = dPsi/dM / kappa = 1 - M^-1 / det M   and   C~ = M - nu N^-1,
// in products that keep their digits near the rest state, where N is as small as the strain.
template <class Number>
struct NaturalState {
  Number stress_determinant;  // det N
  Strain<Number> strain;      // of C~ - 1

  NaturalState(const Number& a, const Number& b, double nu)
  {
    const Number h = a + b, q = 1 + h, q_squared = q * q;  // q = det M
    const Number trace = (3 * a + 4 * b + 2 * h * h) / q_squared;
    stress_determinant = (b + h * (2 * a + 3 * b) + h * h * h) / (q_squared * q);
    const Number inverse_trace = trace / stress_determinant;  // of N^-1
    strain.trace = a - nu * inverse_trace;
    strain.determinant = b - nu * (h * (2 + h) * inverse_trace - 2 * q_squared) + nu * nu / stress_determinant;
  }
};

// mu_1 - 1 and mu_2 - 1 of M from the eigenvalues of N: mu_i = ((1 - n_1) (1 - n_2))^1/3 / (1 - n_i).
Eigen::Array2d natural_strains(const Eigen::Array2d& n)
{
  const Eigen::Array2d logarithms = (-n).log1p();
  return (logarithms.sum() / 3 - logarithms).expm1();
}

// The step of Newton's method for mu_i(n) - nu / n_i = lambda_i, cut where it would leave 0 < n_i < 1.
Eigen::Array2d newton_step(const Eigen::Array2d& n, const Eigen::Array2d& strains, double nu)
{
  const Eigen::Array2d mu_strains = natural_strains(n), ratios = (1 + mu_strains) / 3;
  Eigen::Matrix2d J;
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j) J(i, j) = (i == j ? 2 : -1) * ratios[i] / (1 - n[j]);
  J.diagonal().array() += nu / n.square();
  const Eigen::Array2d step = -(J.inverse() * (mu_strains - nu / n - strains).matrix()).array();
  constexpr double fraction = 0.9;
  const Eigen::Array2d room = (step < 0).select(n, 1 - n);
  return step * std::min(1.0, fraction / (step.abs() / room).maxCoeff());
}

// Trace and determinant of M - 1 for those of C~ - 1.
Strain<double> natural_strain(const Strain<double>& strain, double nu)
{
  const double difference = std::sqrt(std::max(strain.trace * strain.trace - 4 * strain.determinant, 0.0));
  const Eigen::Array2d strains(0.5 * (strain.trace + difference), 0.5 * (strain.trace - difference));
  // First as if M - 1 were N: the positive root of n - nu / n = strain.
  const Eigen::Array2d root = (strains.square() + 4 * nu).sqrt();
  Eigen::Array2d n = (strains > 0).select((strains + root) / 2, 2 * nu / (root - strains)).min(0.9);
  constexpr int most_steps = 100;
  for (int k = 0; k < most_steps; ++k) {
    const Eigen::Array2d step = newton_step(n, strains, nu);
    n += step;
    if ((step.abs() <= 1e-14 * n).all()) break;
  }
  const Eigen::Array2d mu_strains = natural_strains(n);
  return {mu_strains.sum(), mu_strains.prod()};
}

// The natural strain with its derivatives: each pass with the Jacobian of the numbers makes one more order exact.
template <int order>
Strain<Jet<order>> natural_strain(const Strain<Jet<order>>& strain, double nu)
{
  const Strain<double> at = natural_strain(Strain<double>{strain.trace.value(), strain.determinant.value()}, nu);
  const NaturalState<Jet<1>> linear(Jet<1>::first(at.trace), Jet<1>::second(at.determinant), nu);
  Eigen::Matrix2d J;
  J << linear.strain.trace.derivative(1, 0), linear.strain.trace.derivative(0, 1),
      linear.strain.determinant.derivative(1, 0), linear.strain.determinant.derivative(0, 1);
  const Eigen::Matrix2d inverse = J.inverse();
  Strain<Jet<order>> natural{at.trace, at.determinant};
  for (int k = 0; k < order; ++k) {
    const NaturalState<Jet<order>> state(natural.trace, natural.determinant, nu);
    const Jet<order> r = strain.trace - state.strain.trace, s = strain.determinant - state.strain.determinant;
    natural.trace = natural.trace + inverse(0, 0) * r + inverse(0, 1) * s;
    natural.determinant = natural.determinant + inverse(1, 0) * r + inverse(1, 1) * s;
  }
  return natural;
}

// log det W, W = nu N^-1.
template <class Number>
Number log_width(const Strain<Number>& natural, double nu)
{
  return 2 * std::log(nu) - log(NaturalState<Number>(natural.trace, natural.determinant, nu).stress_determinant);
}

// The energy over kappa.
template <class Number>
Number barrier_energy(double nu, double residual, const Strain<Number>& strain)
{
  const Strain<Number> natural = natural_strain(strain, nu);
  return neo_hookean_energy(natural) - nu * log_width(natural, nu) + residual * strain.trace;
}

}  // namespace

BarrierTensionField::BarrierTensionField(double kappa, double barrier, double residual)
    : kappa_(kappa), barrier_(barrier), residual_(residual)
{
  const auto refuse = [](const char* name, double value, const char* cure) {
    throw InputError(fmt::format("barrier_tension_field: {} = {}: it must {}", name, value, cure));
  };
  if (!(kappa > 0) || !std::isfinite(kappa)) refuse("kappa", kappa, "be positive");
  if (!(barrier > 0) || !std::isfinite(barrier)) refuse("barrier", barrier, "be positive");
  if (!(residual >= 0) || !std::isfinite(residual)) refuse("residual", residual, "not be negative");
}

std::vector<MaterialParameter> BarrierTensionField::parameters() const
{
  return {{"kappa", kappa_, "Pa"}, {"barrier", barrier_, "1"}, {"residual", residual_, "1"}};
}

MembraneDensity BarrierTensionField::density(double t, double d, Order order) const
{
  return with_derivatives(
      order, [&](auto jet) { return kappa_ * barrier_energy(barrier_, residual_, strain_of<decltype(jet)>(t, d)); });
}

MembraneDensity BarrierTensionField::density_of_strain(const CauchyGreenInvariants& C, Order order) const
{
  return with_derivatives(
      order, [&](auto jet) { return kappa_ * barrier_energy(barrier_, residual_, strain_itself<decltype(jet)>(C)); });
}

// The energy is a minimum over W: parameters act on it as if W stayed.
MembraneDensity BarrierTensionField::density_derivative(int parameter, double t, double d, Order order) const
{
  return with_derivatives(order, [&](auto jet) -> decltype(jet) {
    const auto strain = strain_of<decltype(jet)>(t, d);
    if (parameter == 0) return barrier_energy(barrier_, residual_, strain);
    if (parameter == 1) return -kappa_ * log_width(natural_strain(strain, barrier_), barrier_);
    return kappa_ * strain.trace;
  });
}

}  // namespace softform
