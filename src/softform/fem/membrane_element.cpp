#include "softform/fem/membrane_element.hpp"

#include <cmath>

#include "softform/core/dual.hpp"

namespace softform {

/// A number and its derivative in one direction.
using Directional = DualNumber<1>;

namespace {

template <class Scalar>
using Vec6 = Eigen::Matrix<Scalar, 6, 1>;
template <class Scalar>
using Mat6 = Eigen::Matrix<Scalar, 6, 6>;

template <class Scalar>
Mat6<Scalar> symmetric_product(const Vec6<Scalar>& a, const Vec6<Scalar>& b)
{
  return a * b.transpose() + b * a.transpose();
}

// The constant second derivatives of N, of D of the differences uu - UU, uv - UV, vv - VV, and of Q in
// q = (uu, uv, vv, UU, UV, VV).
struct BilinearForms {
  Mat6<double> N = Mat6<double>::Zero(), D = Mat6<double>::Zero(), Q = Mat6<double>::Zero();
  BilinearForms()
  {
    N(0, 5) = N(5, 0) = N(2, 3) = N(3, 2) = 1;
    N(1, 4) = N(4, 1) = -2;
    Eigen::Matrix3d determinant;
    determinant << 0, 0, 1, 0, -2, 0, 1, 0, 0;
    D << determinant, -determinant, -determinant, determinant;
    Q(3, 5) = Q(5, 3) = 1;
    Q(4, 4) = -2;
  }
};

const BilinearForms forms;

// Densities take real invariants: a derivative of these goes through the density's own next derivatives.
BasicMembraneDensity<Directional> directional_density(const Material& material, const CauchyGreenInvariants& C,
                                                      const Directional& t, const Directional& d)
{
  const MembraneDensity f = material.density_of_strain(C, Order::Third);
  const auto along = [&](double value, double by_t, double by_d) {
    return Directional::with_derivative(value, 0, by_t * t.derivative(0) + by_d * d.derivative(0));
  };
  BasicMembraneDensity<Directional> g;
  g.psi = along(f.psi, f.psi_t, f.psi_d);
  g.psi_t = along(f.psi_t, f.psi_tt, f.psi_td);
  g.psi_d = along(f.psi_d, f.psi_td, f.psi_dd);
  g.psi_tt = along(f.psi_tt, f.psi_ttt, f.psi_ttd);
  g.psi_td = along(f.psi_td, f.psi_ttd, f.psi_tdd);
  g.psi_dd = along(f.psi_dd, f.psi_tdd, f.psi_ddd);
  return g;
}

// W and its derivatives at q = (uu, uv, vv, UU, UV, VV); density_at: (trace, determinant of C~ - 1) ->
// BasicMembraneDensity<Scalar> of these two, called t and d here.
template <class Scalar, class DensityAt>
void evaluate(const DensityAt& density_at, double thickness, const Vec6<Scalar>& q, Order order, Scalar& energy,
              Vec6<Scalar>& gradient, Mat6<Scalar>& hessian)
{
  using std::sqrt;
  const Scalar A = q[3], B = q[4], C = q[5];
  const Scalar a = q[0] - A, b = q[1] - B, c = q[2] - C;
  const Scalar h(thickness), Q = A * C - B * B;
  const Scalar t = (C * a - 2.0 * B * b + A * c) / Q;
  const Scalar d = (a * c - b * b) / Q;
  const Scalar area = 0.5 * sqrt(Q);
  const BasicMembraneDensity<Scalar> density = density_at(t, d);
  energy = h * area * density.psi;
  if (order == Order::Value) return;

  // N of the differences is N - 2 Q.
  const Scalar zero(0);
  Vec6<Scalar> N_q, D_q, Q_q;
  N_q << C, -2.0 * B, A, c - C, -2.0 * (b - B), a - A;
  D_q << c, -2.0 * b, a, -c, 2.0 * b, -a;
  Q_q << zero, zero, zero, C, -2.0 * B, A;
  const Vec6<Scalar> t_q = (N_q - t * Q_q) / Q;
  const Vec6<Scalar> d_q = (D_q - d * Q_q) / Q;
  const Vec6<Scalar> area_q = area / (2.0 * Q) * Q_q;
  const Vec6<Scalar> psi_q = density.psi_t * t_q + density.psi_d * d_q;
  gradient = h * (density.psi * area_q + area * psi_q);
  if (order == Order::Gradient) return;

  const Mat6<Scalar> D_qq = forms.D.cast<Scalar>(), Q_qq = forms.Q.cast<Scalar>();
  const Mat6<Scalar> N_qq = forms.N.cast<Scalar>() - 2.0 * Q_qq;
  const Mat6<Scalar> t_qq = (N_qq - t * Q_qq - symmetric_product(t_q, Q_q)) / Q;
  const Mat6<Scalar> d_qq = (D_qq - d * Q_qq - symmetric_product(d_q, Q_q)) / Q;
  const Mat6<Scalar> area_qq = area / (2.0 * Q) * (Q_qq - Q_q * Q_q.transpose() / (2.0 * Q));
  const Mat6<Scalar> psi_qq = density.psi_t * t_qq + density.psi_d * d_qq + density.psi_tt * t_q * t_q.transpose() +
                              density.psi_td * symmetric_product(t_q, d_q) + density.psi_dd * d_q * d_q.transpose();
  hessian = h * (density.psi * area_qq + symmetric_product(area_q, psi_q) + area * psi_qq);
}

Vec6<double> products_of(const EdgeProducts& deformed, const EdgeProducts& rest)
{
  Vec6<double> q;
  q << deformed.uu, deformed.uv, deformed.vv, rest.uu, rest.uv, rest.vv;
  return q;
}

}  // namespace

CauchyGreenInvariants cauchy_green_invariants(const EdgeProducts& deformed, const EdgeProducts& rest)
{
  const double Q = rest.uu * rest.vv - rest.uv * rest.uv;
  const auto trace = [&](const EdgeProducts& q) { return (rest.vv * q.uu - 2 * rest.uv * q.uv + rest.uu * q.vv) / Q; };
  const auto determinant = [&](const EdgeProducts& q) { return (q.uu * q.vv - q.uv * q.uv) / Q; };
  const EdgeProducts change{deformed.uu - rest.uu, deformed.uv - rest.uv, deformed.vv - rest.vv};
  return {trace(deformed), determinant(deformed), trace(change), determinant(change)};
}

void evaluate_membrane_element(const Material& material, double thickness, const EdgeProducts& deformed,
                               const EdgeProducts& rest, Order order, MembraneElement& element)
{
  const CauchyGreenInvariants C = cauchy_green_invariants(deformed, rest);
  const auto density_at = [&](double, double) { return material.density_of_strain(C, order); };
  evaluate<double>(density_at, thickness, products_of(deformed, rest), order, element.energy, element.gradient,
                   element.hessian);
}

void evaluate_parameter_derivative(const Material& material, int parameter, double thickness,
                                   const EdgeProducts& deformed, const EdgeProducts& rest, Order order,
                                   MembraneElement& element)
{
  const CauchyGreenInvariants C = cauchy_green_invariants(deformed, rest);
  const auto density_at = [&](double, double) {
    return by_strain(material.density_derivative(parameter, C.t, C.d, order));
  };
  evaluate<double>(density_at, thickness, products_of(deformed, rest), order, element.energy, element.gradient,
                   element.hessian);
}

Eigen::Matrix<double, 6, 6> contracted_third_derivative(const Material& material, double thickness,
                                                        const EdgeProducts& deformed, const EdgeProducts& rest,
                                                        const Vec3& s)
{
  Vec6<Directional> q = products_of(deformed, rest).cast<Directional>();
  for (int k = 0; k < 3; ++k) q[k] = Directional::with_derivative(q[k].value(), 0, s[k]);
  Directional energy;
  Vec6<Directional> gradient;
  Mat6<Directional> hessian;
  const CauchyGreenInvariants C = cauchy_green_invariants(deformed, rest);
  const auto density_at = [&](const Directional& t, const Directional& d) {
    return directional_density(material, C, t, d);
  };
  evaluate<Directional>(density_at, thickness, q, Order::Hessian, energy, gradient, hessian);
  return hessian.unaryExpr([](const Directional& entry) { return entry.derivative(0); });
}

}  // namespace softform
