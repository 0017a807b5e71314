#include "softform/fem/membrane_element.hpp"

#include <cmath>

namespace softform {
namespace {

using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;

Mat6 symmetric_product(const Vec6& a, const Vec6& b) { return a * b.transpose() + b * a.transpose(); }

// The constant second derivatives of N, D and Q in q = (uu, uv, vv, UU, UV, VV).
struct BilinearForms {
  Mat6 N = Mat6::Zero(), D = Mat6::Zero(), Q = Mat6::Zero();
  BilinearForms()
  {
    N(0, 5) = N(5, 0) = N(2, 3) = N(3, 2) = 1;
    N(1, 4) = N(4, 1) = -2;
    D(0, 2) = D(2, 0) = 1;
    D(1, 1) = -2;
    Q(3, 5) = Q(5, 3) = 1;
    Q(4, 4) = -2;
  }
};

const BilinearForms forms;

// density_at: (t, d) -> MembraneDensity.
template <class DensityAt>
void evaluate(const DensityAt& density_at, double thickness, const EdgeProducts& deformed, const EdgeProducts& rest,
              Order order, MembraneElement& element)
{
  const auto& [a, b, c] = deformed;
  const auto& [A, B, C] = rest;
  const double Q = A * C - B * B;
  const double t = (C * a - 2 * B * b + A * c) / Q;
  const double d = (a * c - b * b) / Q;
  const double area = 0.5 * std::sqrt(Q);
  const MembraneDensity density = density_at(t, d);
  element.energy = thickness * area * density.psi;
  if (order == Order::Value) return;

  Vec6 N_q, D_q, Q_q;
  N_q << C, -2 * B, A, c, -2 * b, a;
  D_q << c, -2 * b, a, 0, 0, 0;
  Q_q << 0, 0, 0, C, -2 * B, A;
  const Vec6 t_q = (N_q - t * Q_q) / Q;
  const Vec6 d_q = (D_q - d * Q_q) / Q;
  const Vec6 area_q = area / (2 * Q) * Q_q;
  const Vec6 psi_q = density.psi_t * t_q + density.psi_d * d_q;
  element.gradient = thickness * (density.psi * area_q + area * psi_q);
  if (order == Order::Gradient) return;

  const Mat6 t_qq = (forms.N - t * forms.Q - symmetric_product(t_q, Q_q)) / Q;
  const Mat6 d_qq = (forms.D - d * forms.Q - symmetric_product(d_q, Q_q)) / Q;
  const Mat6 area_qq = area / (2 * Q) * (forms.Q - Q_q * Q_q.transpose() / (2 * Q));
  const Mat6 psi_qq = density.psi_t * t_qq + density.psi_d * d_qq + density.psi_tt * t_q * t_q.transpose() +
                      density.psi_td * symmetric_product(t_q, d_q) + density.psi_dd * d_q * d_q.transpose();
  element.hessian = thickness * (density.psi * area_qq + symmetric_product(area_q, psi_q) + area * psi_qq);
}

}  // namespace

void evaluate_membrane_element(const Material& material, double thickness, const EdgeProducts& deformed,
                               const EdgeProducts& rest, Order order, MembraneElement& element)
{
  const auto density_at = [&](double t, double d) { return material.density(t, d, order); };
  evaluate(density_at, thickness, deformed, rest, order, element);
}

void evaluate_parameter_derivative(const Material& material, int parameter, double thickness,
                                   const EdgeProducts& deformed, const EdgeProducts& rest, Order order,
                                   MembraneElement& element)
{
  const auto density_at = [&](double t, double d) { return material.density_derivative(parameter, t, d, order); };
  evaluate(density_at, thickness, deformed, rest, order, element);
}

Eigen::Matrix<double, 3, 9> TriangleEdges::jacobian() const
{
  Eigen::Matrix<double, 3, 9> J;
  J << -2 * u.transpose(), 2 * u.transpose(), Eigen::RowVector3d::Zero(),  //
      -(u + v).transpose(), v.transpose(), u.transpose(),                  //
      -2 * v.transpose(), Eigen::RowVector3d::Zero(), 2 * v.transpose();
  return J;
}

Eigen::Matrix3d TriangleEdges::second_derivative(const Vec3& weights)
{
  const double uu = 2 * weights[0], uv = weights[1], vv = 2 * weights[2];
  Eigen::Matrix3d pairs;
  pairs << uu + 2 * uv + vv, -uu - uv, -uv - vv,  //
      -uu - uv, uu, uv,                           //
      -uv - vv, uv, vv;
  return pairs;
}

}  // namespace softform
