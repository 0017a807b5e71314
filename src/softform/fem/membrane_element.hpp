#pragma once

#include <cmath>

#include <Eigen/Core>

#include "softform/core/types.hpp"
#include "softform/materials/material.hpp"

namespace softform {

/// The edge dot products of a triangle with edge vectors u = x1 - x0 and v = x2 - x0: (u.u, u.v, v.v) [m^2].
struct EdgeProducts {
  double uu, uv, vv;

  double area() const { return 0.5 * std::sqrt(uu * vv - uv * uv); }
};

/// Of the in-plane Cauchy-Green tensor C~.
CauchyGreenInvariants cauchy_green_invariants(const EdgeProducts& deformed, const EdgeProducts& rest);

/// The constant-strain membrane element of thesis 3.1.4 under its two kinematic assumptions, no transverse shear and
/// incompressibility: W = h A Psi(t, d) [J] as a function of the six edge dot products
/// q = (u.u, u.v, v.v of the deformed triangle; U.U, U.V, V.V of the rest triangle),
///     Q = UU VV - UV^2,  N = VV uu - 2 UV uv + UU vv,  D = uu vv - uv^2,
///     t = tr C~ = N / Q,  d = det C~ = D / Q,  A = sqrt(Q) / 2.
/// The dot products are the first fundamental forms, so that no material frame (3.32) is needed. The derivatives go
/// through the invariants of C~ - 1, which are N and D of the differences of deformed and rest products, over Q.
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

/// Edge vectors of a triangle in 2 or 3 dimensions and what turns derivatives in dot products into derivatives in
/// vertices.
template <int dimension>
struct EdgesOf {
  Eigen::Matrix<double, dimension, 1> u, v;

  /// x: the flat state vector of all vertices (dimension n); i, j, k: those of the triangle.
  EdgesOf(ConstVec x, int i, int j, int k) : u(point(x, j) - point(x, i)), v(point(x, k) - point(x, i)) {}

  EdgeProducts products() const { return {u.dot(u), u.dot(v), v.dot(v)}; }

  /// d(uu, uv, vv) / d(x0, x1, x2), (3, 3 dimension).
  Eigen::Matrix<double, 3, 3 * dimension> jacobian() const
  {
    const Eigen::Matrix<double, 1, dimension> zero = Eigen::Matrix<double, 1, dimension>::Zero();
    Eigen::Matrix<double, 3, 3 * dimension> J;
    J << -2 * u.transpose(), 2 * u.transpose(), zero,        //
        -(u + v).transpose(), v.transpose(), u.transpose(),  //
        -2 * v.transpose(), zero, 2 * v.transpose();
    return J;
  }

  /// sum_k weights_k d2(uu, uv, vv)_k / d(x0, x1, x2)^2: a (3, 3) matrix of vertex pairs, each entry times the
  /// identity.
  static Eigen::Matrix3d second_derivative(const Vec3& weights)
  {
    const double uu = 2 * weights[0], uv = weights[1], vv = 2 * weights[2];
    Eigen::Matrix3d pairs;
    pairs << uu + 2 * uv + vv, -uu - uv, -uv - vv,  //
        -uu - uv, uu, uv,                           //
        -uv - vv, uv, vv;
    return pairs;
  }

 private:
  static auto point(ConstVec x, int i) { return x.segment<dimension>(dimension * Eigen::Index(i)); }
};
using TriangleEdges = EdgesOf<3>;
using FlatTriangleEdges = EdgesOf<2>;

}  // namespace softform
