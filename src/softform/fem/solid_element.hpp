#pragma once

#include <Eigen/Core>

#include "softform/materials/solid_material.hpp"

namespace softform {

/// The constant-strain element of section 5.3.1 in the plane (dim = 2) and in space (dim = 3), as functions of its
/// deformation gradient F and the density's derivatives at I = |F|^2 and J = det F. Matrices of second derivatives are
/// (dim^2, dim^2), F column by column. With c = cof F = dJ/dF:
///     P = 2 psi_I F + psi_J c.

template <int dim>
using Gradient = Eigen::Matrix<double, dim, dim>;
template <int dim>
using GradientHessian = Eigen::Matrix<double, dim * dim, dim * dim>;

/// dJ/dF.
template <int dim>
Gradient<dim> cofactor(const Gradient<dim>& F);

/// P = d psi/dF [Pa], the first Piola-Kirchhoff stress.
template <int dim>
Gradient<dim> stress(const SolidDensity& density, const Gradient<dim>& F);

/// d2 psi/dF2 [Pa].
template <int dim>
GradientHessian<dim> stress_derivative(const SolidDensity& density, const Gradient<dim>& F);

/// The same with its negative eigenvalues cut to zero, by the closed eigensystems of isotropic energies (Smith, de Goes
/// and Kim 2019): in the frame of the singular values, a block of stretches and a twist and a flip for every pair.
template <int dim>
GradientHessian<dim> projected_stress_derivative(const SolidDensity& density, const Gradient<dim>& F);

/// The derivative of d2 psi/dF2 along a change L of F: the third derivative contracted once. Needs Order::Third.
template <int dim>
GradientHessian<dim> stress_derivative_change(const SolidDensity& density, const Gradient<dim>& F,
                                              const Gradient<dim>& L);

}  // namespace softform
