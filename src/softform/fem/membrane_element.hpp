#pragma once

#include <Eigen/Core>

#include "softform/core/types.hpp"
#include "softform/materials/material.hpp"

namespace softform {

/// The edge dot products of a triangle with edge vectors u = x1 - x0 and v = x2 - x0: (u.u, u.v, v.v) [m^2].
struct EdgeProducts {
  double uu, uv, vv;
};

/// The constant-strain membrane element of thesis 3.1.4 under its two kinematic assumptions, no transverse shear and
/// incompressibility: W = h A Psi(t, d) [J] as a function of the six edge dot products
/// q = (u.u, u.v, v.v of the deformed triangle; U.U, U.V, V.V of the rest triangle),
///     Q = UU VV - UV^2,  N = VV uu - 2 UV uv + UU vv,  D = uu vv - uv^2,
///     t = tr C~ = N / Q,  d = det C~ = D / Q,  A = sqrt(Q) / 2.
/// The dot products are the first fundamental forms, so that no material frame (3.32) is needed.
struct MembraneElement {
  double energy = 0;                     ///< W [J]
  Eigen::Matrix<double, 6, 1> gradient;  ///< dW/dq [N/m]
  Eigen::Matrix<double, 6, 6> hessian;   ///< d2W/dq2 [N/m^3]
};

/// Evaluates the element. Fills the gradient for Order::Gradient and the Hessian for Order::Hessian.
void evaluate_membrane_element(const Material& material, double thickness, const EdgeProducts& deformed,
                               const EdgeProducts& rest, Order order, MembraneElement& element);

/// The derivative of the element's Hessian d2W/dq2 along a change s of the deformed dot products: its third derivative
/// contracted with s (6, 6), by dual numbers.
Eigen::Matrix<double, 6, 6> contracted_third_derivative(const Material& material, double thickness,
                                                        const EdgeProducts& deformed, const EdgeProducts& rest,
                                                        const Vec3& s);

/// The derivative of the element in a parameter of the material: dW/d(parameter) and its derivatives in q.
void evaluate_parameter_derivative(const Material& material, int parameter, double thickness,
                                   const EdgeProducts& deformed, const EdgeProducts& rest, Order order,
                                   MembraneElement& element);

/// Edge vectors of a triangle and what turns derivatives in dot products into derivatives in vertices.
struct TriangleEdges {
  Vec3 u, v;

  TriangleEdges(ConstVec x, int i, int j, int k) : u(vertex(x, j) - vertex(x, i)), v(vertex(x, k) - vertex(x, i)) {}

  EdgeProducts products() const { return {u.dot(u), u.dot(v), v.dot(v)}; }

  /// d(uu, uv, vv) / d(x0, x1, x2), (3, 9).
  Eigen::Matrix<double, 3, 9> jacobian() const;

  /// sum_k weights_k d2(uu, uv, vv)_k / d(x0, x1, x2)^2: a (3, 3) matrix of vertex pairs, each entry times the
  /// identity.
  static Eigen::Matrix3d second_derivative(const Vec3& weights);
};

}  // namespace softform
