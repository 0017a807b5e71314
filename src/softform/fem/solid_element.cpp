#include "softform/fem/solid_element.hpp"

#include <algorithm>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/SVD>

namespace softform {
namespace {

template <int dim>
using Flat = Eigen::Matrix<double, dim * dim, 1>;

template <int dim>
Flat<dim> flat(const Gradient<dim>& F)
{
  return Eigen::Map<const Flat<dim>>(F.data());
}

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& a)
{
  Eigen::Matrix3d A;
  A << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return A;
}

// d cof(F)/dF: constant in the plane, linear in F in space, where the columns of cof F are cross products of F's.
GradientHessian<2> cofactor_derivative(const Gradient<2>&)
{
  GradientHessian<2> D = GradientHessian<2>::Zero();
  D(0, 3) = D(3, 0) = 1;
  D(1, 2) = D(2, 1) = -1;
  return D;
}

GradientHessian<3> cofactor_derivative(const Gradient<3>& F)
{
  GradientHessian<3> D = GradientHessian<3>::Zero();
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    const Eigen::Matrix3d A = cross_matrix(F.col(k));
    D.block<3, 3>(3 * j, 3 * i) = A;
    D.block<3, 3>(3 * i, 3 * j) = -A;
  }
  return D;
}

GradientHessian<2> cofactor_second_derivative(const Gradient<2>&) { return GradientHessian<2>::Zero(); }
GradientHessian<3> cofactor_second_derivative(const Gradient<3>& L) { return cofactor_derivative(L); }

// Rotations U, V and signed singular values, F = U diag(sigma) V^t.
template <int dim>
struct SignedSvd {
  Gradient<dim> U, V;
  Eigen::Matrix<double, dim, 1> sigma;

  explicit SignedSvd(const Gradient<dim>& F)
  {
    const Eigen::JacobiSVD<Gradient<dim>> svd(F, Eigen::ComputeFullU | Eigen::ComputeFullV);
    U = svd.matrixU();
    V = svd.matrixV();
    sigma = svd.singularValues();
    if (U.determinant() * V.determinant() < 0) {
      U.col(dim - 1) *= -1;
      sigma[dim - 1] *= -1;
    }
  }
};

// The product of the singular values other than i and j: dc_i/d sigma_j.
template <int dim>
double remaining_product(const Eigen::Matrix<double, dim, 1>& sigma, int i, int j)
{
  return dim == 2 ? 1 : sigma[3 - i - j];
}

// d2 psi/d sigma2.
template <int dim>
Gradient<dim> stretch_hessian(const SolidDensity& f, const Eigen::Matrix<double, dim, 1>& sigma)
{
  Eigen::Matrix<double, dim, 1> c;
  for (int i = 0; i < dim; ++i) c[i] = dim == 2 ? sigma[1 - i] : sigma[(i + 1) % dim] * sigma[(i + 2) % dim];
  Gradient<dim> A = 4 * f.psi_II * sigma * sigma.transpose() +
                    2 * f.psi_IJ * (sigma * c.transpose() + c * sigma.transpose()) + f.psi_JJ * c * c.transpose();
  A.diagonal().array() += 2 * f.psi_I;
  for (int i = 0; i < dim; ++i)
    for (int j = 0; j < dim; ++j)
      if (i != j) A(i, j) += f.psi_J * remaining_product<dim>(sigma, i, j);
  return A;
}

}  // namespace

template <>
Gradient<2> cofactor<2>(const Gradient<2>& F)
{
  Gradient<2> c;
  c << F(1, 1), -F(1, 0), -F(0, 1), F(0, 0);
  return c;
}

template <>
Gradient<3> cofactor<3>(const Gradient<3>& F)
{
  Gradient<3> c;
  c << F.col(1).cross(F.col(2)), F.col(2).cross(F.col(0)), F.col(0).cross(F.col(1));
  return c;
}

template <int dim>
Gradient<dim> stress(const SolidDensity& density, const Gradient<dim>& F)
{
  return 2 * density.psi_I * F + density.psi_J * cofactor<dim>(F);
}

//  d2 psi/dF2 = 2 psi_I 1 + 4 psi_II F F + 2 psi_IJ (F c + c F) + psi_JJ c c + psi_J dc/dF   (products are dyadic).
template <int dim>
GradientHessian<dim> stress_derivative(const SolidDensity& density, const Gradient<dim>& F)
{
  const Flat<dim> f = flat<dim>(F), c = flat<dim>(cofactor<dim>(F));
  GradientHessian<dim> H = density.psi_J * cofactor_derivative(F);
  H += (density.psi_JJ * c) * c.transpose();
  if (density.psi_II != 0) H += (4 * density.psi_II * f) * f.transpose();
  if (density.psi_IJ != 0) H += 2 * density.psi_IJ * (f * c.transpose() + c * f.transpose());
  H.diagonal().array() += 2 * density.psi_I;
  return H;
}

template <int dim>
GradientHessian<dim> projected_stress_derivative(const SolidDensity& density, const Gradient<dim>& F)
{
  const SignedSvd<dim> svd(F);
  GradientHessian<dim> H = GradientHessian<dim>::Zero();
  const auto add = [&](double eigenvalue, const Gradient<dim>& mode) {
    const Flat<dim> v = flat<dim>(svd.U * mode * svd.V.transpose());
    if (eigenvalue > 0) H += (eigenvalue * v) * v.transpose();
  };
  const Eigen::SelfAdjointEigenSolver<Gradient<dim>> stretches(stretch_hessian<dim>(density, svd.sigma));
  for (int k = 0; k < dim; ++k)
    add(stretches.eigenvalues()[k], Gradient<dim>(stretches.eigenvectors().col(k).asDiagonal()));
  for (int i = 0; i < dim; ++i) {
    for (int j = 0; j < i; ++j) {
      const double coupling = density.psi_J * remaining_product<dim>(svd.sigma, i, j);
      Gradient<dim> twist = Gradient<dim>::Zero(), flip = Gradient<dim>::Zero();
      twist(i, j) = flip(i, j) = flip(j, i) = std::sqrt(0.5);
      twist(j, i) = -twist(i, j);
      add(2 * density.psi_I + coupling, twist);
      add(2 * density.psi_I - coupling, flip);
    }
  }
  return H;
}

// The product rule on the five terms of stress_derivative.
template <int dim>
GradientHessian<dim> stress_derivative_change(const SolidDensity& density, const Gradient<dim>& F,
                                              const Gradient<dim>& L)
{
  const GradientHessian<dim> D = cofactor_derivative(F);
  const Flat<dim> f = flat<dim>(F), c = flat<dim>(cofactor<dim>(F)), l = flat<dim>(L), dc = D * l;
  const double dI = 2 * f.dot(l), dJ = c.dot(l);
  const auto change = [&](double by_I, double by_J) { return by_I * dI + by_J * dJ; };
  const auto both = [](const Flat<dim>& a, const Flat<dim>& b) -> GradientHessian<dim> {
    return a * b.transpose() + b * a.transpose();
  };
  GradientHessian<dim> T = change(density.psi_IJ, density.psi_JJ) * D + density.psi_J * cofactor_second_derivative(L);
  T += 4 * change(density.psi_III, density.psi_IIJ) * f * f.transpose() + 4 * density.psi_II * both(f, l);
  T += 2 * change(density.psi_IIJ, density.psi_IJJ) * both(f, c) + 2 * density.psi_IJ * (both(l, c) + both(f, dc));
  T += change(density.psi_IJJ, density.psi_JJJ) * c * c.transpose() + density.psi_JJ * both(c, dc);
  T.diagonal().array() += 2 * change(density.psi_II, density.psi_IJ);
  return T;
}

template Gradient<2> stress<2>(const SolidDensity&, const Gradient<2>&);
template Gradient<3> stress<3>(const SolidDensity&, const Gradient<3>&);
template GradientHessian<2> stress_derivative<2>(const SolidDensity&, const Gradient<2>&);
template GradientHessian<3> stress_derivative<3>(const SolidDensity&, const Gradient<3>&);
template GradientHessian<2> projected_stress_derivative<2>(const SolidDensity&, const Gradient<2>&);
template GradientHessian<3> projected_stress_derivative<3>(const SolidDensity&, const Gradient<3>&);
template GradientHessian<2> stress_derivative_change<2>(const SolidDensity&, const Gradient<2>&, const Gradient<2>&);
template GradientHessian<3> stress_derivative_change<3>(const SolidDensity&, const Gradient<3>&, const Gradient<3>&);

}  // namespace softform
