#pragma once

#include <memory>

#include <gtest/gtest.h>

#include "softform/fem/membrane.hpp"
#include "support/deformations.hpp"
#include "support/finite_differences.hpp"

/// Derivatives of a membrane material at one deformation: of its density in t and d, in its parameters, and those of a
/// patch of panels made of it.
namespace softform::testing {

inline Vec gradient_of(const MembraneDensity& f) { return Eigen::Vector2d(f.psi_t, f.psi_d); }
inline Vec hessian_of(const MembraneDensity& f) { return Eigen::Vector3d(f.psi_tt, f.psi_td, f.psi_dd); }
inline Vec third_of(const MembraneDensity& f) { return Eigen::Vector4d(f.psi_ttt, f.psi_ttd, f.psi_tdd, f.psi_ddd); }

/// Up to third derivatives. The stretches must differ by more than the steps.
inline void expect_density_slopes(const Material& material, double t, double d, double step = 1e-4)
{
  const double scale = material.shear_modulus() / 2;
  const Vec invariants = Eigen::Vector2d(t, d), direction = Eigen::Vector2d(0.8, 0.5);
  const auto at = [&](const Vec& q, Order order) { return material.density(q[0], q[1], order); };
  const MembraneDensity f = at(invariants, Order::Third);
  EXPECT_SLOPE(check_slope([&](const Vec& q) { return Vec::Constant(1, at(q, Order::Value).psi); }, invariants,
                           direction, Vec::Constant(1, gradient_of(f).dot(direction)), step, scale));
  const Vec second = Eigen::Vector2d(f.psi_tt * direction[0] + f.psi_td * direction[1],
                                     f.psi_td * direction[0] + f.psi_dd * direction[1]);
  EXPECT_SLOPE(check_slope([&](const Vec& q) { return gradient_of(at(q, Order::Gradient)); }, invariants, direction,
                           second, step, scale));
  const Vec third = Eigen::Vector3d(f.psi_ttt * direction[0] + f.psi_ttd * direction[1],
                                    f.psi_ttd * direction[0] + f.psi_tdd * direction[1],
                                    f.psi_tdd * direction[0] + f.psi_ddd * direction[1]);
  EXPECT_SLOPE(check_slope([&](const Vec& q) { return hessian_of(at(q, Order::Hessian)); }, invariants, direction,
                           third, step, scale));
}

/// Trace and determinant of C~ - 1 in the places of t and d: another density of the same energy.
inline void expect_same_density_of_strain(const Material& material, double t, double d)
{
  const MembraneDensity f = material.density_of_strain({t, d, t - 2, d - t + 1}, Order::Third);
  const MembraneDensity g = by_strain(material.density(t, d, Order::Third));
  const double scale = material.shear_modulus() + std::abs(g.psi_ttt) + std::abs(g.psi_ddd);
  EXPECT_NEAR(f.psi, g.psi, 1e-10 * scale);
  EXPECT_LT((gradient_of(f) - gradient_of(g)).norm(), 1e-10 * scale);
  EXPECT_LT((hessian_of(f) - hessian_of(g)).norm(), 1e-10 * scale);
  EXPECT_LT((third_of(f) - third_of(g)).norm(), 1e-10 * scale);
}

/// make: from the values of all parameters.
template <class Make>
void expect_parameter_slopes(const Make& make, const Vec& values, double t, double d)
{
  const auto material = make(values);
  for (int k = 0; k < values.size(); ++k) {
    const auto gradient = [&](const Vec& v) { return gradient_of(make(v).density(t, d, Order::Gradient)); };
    const Vec direction = values[k] * Vec::Unit(values.size(), k);
    const Vec exact = values[k] * gradient_of(material.density_derivative(k, t, d, Order::Gradient));
    EXPECT_SLOPE(check_slope(gradient, values, direction, exact, 1e-3, material.shear_modulus() / 2));
  }
}

/// Four triangles of two flat panels, all in about the same state.
class Patch {
 public:
  Patch(std::shared_ptr<const Material> material, double lambda_1, double lambda_2, double unevenness)
      : membrane(triangles(), 5, rest_triangles(), 6, std::move(material), Vec::Constant(4, 1e-3)), flat(12), x(15)
  {
    flat << 0, 0, 1, 0.1, 1.1, 0.9, 0.1, 1, 0.45, 0.55, 0.45, 0.55;
    const double s_1 = std::sqrt(lambda_1), s_2 = std::sqrt(lambda_2);
    for (int i = 0; i < 5; ++i) {
      const double X = flat[2 * i], Y = flat[2 * i + 1];
      const double u = 0.8 * X + 0.6 * Y, v = -0.6 * X + 0.8 * Y;
      x.segment<3>(3 * i) << s_1 * u, 0.8 * s_2 * v, 0.6 * s_2 * v;
    }
    x += unevenness * wiggle(15, 2);
  }

  static Triangles triangles()
  {
    Triangles t(4, 3);
    t << 0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4;
    return t;
  }
  static Triangles rest_triangles()
  {
    Triangles t = triangles();
    t(2, 2) = t(3, 2) = 5;  // the middle node has a flat position in each panel
    return t;
  }

  PanelMembrane membrane;
  Vec flat, x;
};

/// Of forces, stiffness and third derivatives, in nodes and in flat positions.
inline void expect_panel_slopes(const std::shared_ptr<const Material>& material, double lambda_1, double lambda_2,
                                double step = 1e-4, double unevenness = 2e-3)
{
  const Patch patch(material, lambda_1, lambda_2, unevenness);
  const PanelMembrane& W = patch.membrane;
  const Vec &x = patch.x, &X = patch.flat;
  const Vec d = wiggle(15, 3), D = wiggle(12, 4), lambda = wiggle(15, 5);
  const double scale = material->shear_modulus() / 2 * 1e-3;
  const auto value = [&](const Vec& y, const Vec& Y) { return Vec::Constant(1, W.value(y, Y)); };
  const auto forces = [&](const Vec& y, const Vec& Y) -> Vec {
    Vec g;
    W.gradient(y, Y, g);
    return g;
  };
  const auto rest_forces = [&](const Vec& y, const Vec& Y) -> Vec {
    Vec g;
    W.rest_gradient(y, Y, g);
    return g;
  };
  SparseMatrix K, B, xx, mixed, XX;
  W.hessian(x, X, K);
  W.mixed_hessian(x, X, B);
  const Vec f = forces(x, X), F = rest_forces(x, X);
  EXPECT_SLOPE(check_slope([&](const Vec& y) { return value(y, X); }, x, d, Vec::Constant(1, f.dot(d)), step, scale));
  EXPECT_SLOPE(check_slope([&](const Vec& Y) { return value(x, Y); }, X, D, Vec::Constant(1, F.dot(D)), step, scale));
  EXPECT_SLOPE(check_slope([&](const Vec& y) { return forces(y, X); }, x, d, K * d, step, scale));
  EXPECT_SLOPE(check_slope([&](const Vec& Y) { return forces(x, Y); }, X, D, B * D, step, scale));
  EXPECT_SLOPE(check_slope([&](const Vec& y) { return rest_forces(y, X); }, x, d, B.transpose() * d, step, scale));

  W.force_hessian(x, X, lambda, xx, mixed, XX);
  const auto by_x = [&](const Vec& y, const Vec& Y) -> Vec {
    SparseMatrix H;
    W.hessian(y, Y, H);
    return H * lambda;
  };
  const auto by_rest = [&](const Vec& y, const Vec& Y) -> Vec {
    SparseMatrix H;
    W.mixed_hessian(y, Y, H);
    return H.transpose() * lambda;
  };
  EXPECT_SLOPE(check_slope([&](const Vec& y) { return by_x(y, X); }, x, d, xx * d, step, scale));
  EXPECT_SLOPE(check_slope([&](const Vec& Y) { return by_x(x, Y); }, X, D, mixed * D, step, scale));
  EXPECT_SLOPE(check_slope([&](const Vec& y) { return by_rest(y, X); }, x, d, mixed.transpose() * d, step, scale));
  EXPECT_SLOPE(check_slope([&](const Vec& Y) { return by_rest(x, Y); }, X, D, XX * D, step, scale));
}

}  // namespace softform::testing
