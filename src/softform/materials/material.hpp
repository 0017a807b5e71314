#pragma once

#include <string>
#include <vector>

namespace softform {

/// How many derivatives are wanted.
enum class Order { Value, Gradient, Hessian, Third };

/// A strain-energy density and its derivatives in the two invariants of the in-plane Cauchy-Green tensor C~: t = tr C~
/// = lambda_1^2 + lambda_2^2 and d = det C~ = lambda_1^2 lambda_2^2, at lambda_3^2 = 1/d (incompressible). All in Pa.
/// Entries beyond the order asked for are zero. `Scalar` is that of the material's parameters: a fit differentiates
/// with respect to them.
template <class Scalar>
struct BasicMembraneDensity {
  Scalar psi{0};
  Scalar psi_t{0}, psi_d{0};
  Scalar psi_tt{0}, psi_td{0}, psi_dd{0};
  Scalar psi_ttt{0}, psi_ttd{0}, psi_tdd{0}, psi_ddd{0};
};
using MembraneDensity = BasicMembraneDensity<double>;

/// From derivatives in t and d to those in trace and determinant of C~ - 1: d also changes with the trace.
inline MembraneDensity by_strain(const MembraneDensity& f)
{
  MembraneDensity g = f;
  g.psi_t = f.psi_t + f.psi_d;
  g.psi_tt = f.psi_tt + 2 * f.psi_td + f.psi_dd;
  g.psi_td = f.psi_td + f.psi_dd;
  g.psi_ttt = f.psi_ttt + 3 * (f.psi_ttd + f.psi_tdd) + f.psi_ddd;
  g.psi_ttd = f.psi_ttd + 2 * f.psi_tdd + f.psi_ddd;
  g.psi_tdd = f.psi_tdd + f.psi_ddd;
  return g;
}

/// The invariants of C~, and those of the strain C~ - 1, which keep their digits near the rest state:
/// t = 2 + trace, d = 1 + trace + determinant.
struct CauchyGreenInvariants {
  double t, d;
  double strain_trace, strain_determinant;
};

/// A named number of a material model.
struct MaterialParameter {
  std::string name;
  double value = 0;
  std::string unit;  ///< "Pa" or "1"
};

/// An incompressible isotropic hyperelastic material, point-wise: it knows no mesh and no element.
///
/// With I3 = 1 the density Psi(I1, I2) of thesis (4.3) is a smooth function of t and d alone,
///     I1 = t + 1/d,   I2 = d + t/d,
/// which serves membranes (4.1) and every homogeneous test of rubber alike.
class Material {
 public:
  virtual ~Material() = default;

  /// The model's name in the registry, for example "hart_smith".
  virtual std::string model() const = 0;

  /// The parameters in SI units, in the order of the model's definition.
  virtual std::vector<MaterialParameter> parameters() const = 0;

  /// Psi(t, d) and derivatives up to `order`. Outside the domain (d <= 0, t < 2 sqrt(d) beyond round-off, overflow)
  /// psi is +infinity and the derivatives are zero, never an exception: line searches step there.
  virtual MembraneDensity density(double t, double d, Order order) const = 0;

  /// The same as a function of trace and determinant of the strain C~ - 1, which take the places of t and d. A stiff
  /// material computes its stress from these: a small difference, where d loses as many digits as the strain has zeros.
  virtual MembraneDensity density_of_strain(const CauchyGreenInvariants& C, Order order) const
  {
    return by_strain(density(C.t, C.d, order));
  }

  /// dPsi/d(parameter) and its derivatives in t and d, in Pa per unit of the parameter; zero outside the domain.
  virtual MembraneDensity density_derivative(int parameter, double t, double d, Order order) const = 0;

  /// Shear modulus at rest [Pa]: the unit of stress of dimensionless results.
  virtual double shear_modulus() const = 0;
};

}  // namespace softform
