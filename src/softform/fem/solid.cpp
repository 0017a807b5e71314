#include "softform/fem/solid.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <Eigen/LU>
#include <fmt/format.h>

#include "softform/core/error.hpp"
#include "softform/core/parallel.hpp"

namespace softform {

template <int dim>
Solid<dim>::Solid(Simplices<dim> elements, Vec rest_positions, Mixture mixture, const SolidOptions<dim>& options)
    : elements_(std::move(elements)),
      rest_positions_(std::move(rest_positions)),
      mixture_(std::move(mixture)),
      options_(options),
      pattern_(elements_, vertex_count())
{
  if (dim == 2 && !(options_.thickness > 0))
    throw InputError(fmt::format("the body's thickness is {} m: it must be positive", options_.thickness));
  make_elements();
  make_mixed_pattern();
  const auto count = static_cast<std::size_t>(element_count());
  element_scalars_.resize(count);
  element_vectors_.resize(count * corners * dim);
  element_blocks_.resize(count * corners * corners);
}

// F = x_e S with the gradients S of the linear shape functions: rows 1 to dim are D^-1, all rows sum to zero.
template <int dim>
void Solid<dim>::make_elements()
{
  const double simplex = dim == 2 ? options_.thickness / 2 : 1.0 / 6;
  volumes_.resize(element_count());
  shape_gradients_.resize(static_cast<std::size_t>(element_count()));
  for (int e = 0; e < element_count(); ++e) {
    const Corners X = gather(rest_positions_, e);
    const Gradient<dim> D = X.template rightCols<dim>().colwise() - X.col(0);
    const double determinant = D.determinant();
    if (!(determinant > 1e-9 * std::pow(D.norm(), dim)))
      throw InputError(
          fmt::format("element {} is degenerate or turned over at rest (volume {:.2e}): remesh it, or order "
                      "its corners so that its volume is positive",
                      e, simplex * determinant));
    volumes_[e] = simplex * determinant;
    auto& S = shape_gradients_[static_cast<std::size_t>(e)];
    S.template bottomRows<dim>() = D.inverse();
    S.row(0) = -S.template bottomRows<dim>().colwise().sum();
  }
}

template <int dim>
void Solid<dim>::make_mixed_pattern()
{
  corner_rank_.resize(static_cast<std::size_t>(element_count() * corners));
  mixed_zero_.resize(rest_positions_.size(), element_count());
  mixed_zero_.reserve(Eigen::VectorXi::Constant(element_count(), dim * corners));
  for (int e = 0; e < element_count(); ++e) {
    std::array<int, corners> sorted;
    for (int k = 0; k < corners; ++k) sorted[static_cast<std::size_t>(k)] = elements_(e, k);
    std::sort(sorted.begin(), sorted.end());
    for (int k = 0; k < corners; ++k)
      corner_rank_[static_cast<std::size_t>(corners * e + k)] =
          static_cast<int>(std::find(sorted.begin(), sorted.end(), elements_(e, k)) - sorted.begin());
    for (const int i : sorted)
      for (int p = 0; p < dim; ++p) mixed_zero_.insert(dim * i + p, e) = 0;
  }
  mixed_zero_.makeCompressed();
}

template <int dim>
typename Solid<dim>::Corners Solid<dim>::gather(ConstVec x, int e) const
{
  Corners corner_positions;
  for (int k = 0; k < corners; ++k)
    corner_positions.col(k) = x.template segment<dim>(dim * Eigen::Index(elements_(e, k)));
  return corner_positions;
}

template <int dim>
Gradient<dim> Solid<dim>::deformation_gradient(ConstVec x, int e) const
{
  return gather(x, e) * shape_gradients_[static_cast<std::size_t>(e)];
}

template <int dim>
typename Solid<dim>::Point Solid<dim>::weight_per_corner(int e, double mass_density) const
{
  return (mass_density * volumes_[e] / corners) * options_.gravity;
}

template <int dim>
typename Solid<dim>::Corners Solid<dim>::corner_forces(int e, const Gradient<dim>& P) const
{
  return volumes_[e] * P * shape_gradients_[static_cast<std::size_t>(e)].transpose();
}

template <int dim>
double Solid<dim>::value(ConstVec x, ConstVec rho) const
{
  parallel_for(element_count(), [&](int e) {
    const Corners x_e = gather(x, e);
    const Gradient<dim> F = x_e * shape_gradients_[static_cast<std::size_t>(e)];
    const double psi = mixture_.density(rho[e], F.squaredNorm(), F.determinant(), Order::Value).psi;
    const double weight = weight_per_corner(e, mixture_.mass_density(rho[e])).dot(x_e.rowwise().sum());
    element_scalars_[static_cast<std::size_t>(e)] = volumes_[e] * psi - weight;
  });
  double sum = 0;
  for (const double energy : element_scalars_) sum += energy;
  return sum;
}

template <int dim>
void Solid<dim>::gradient(ConstVec x, ConstVec rho, Vec& g) const
{
  parallel_for(element_count(), [&](int e) {
    const Gradient<dim> F = deformation_gradient(x, e);
    const SolidDensity density = mixture_.density(rho[e], F.squaredNorm(), F.determinant(), Order::Gradient);
    Eigen::Map<Corners> forces(&element_vectors_[static_cast<std::size_t>(e) * corners * dim]);
    forces = corner_forces(e, stress<dim>(density, F));
    forces.colwise() -= weight_per_corner(e, mixture_.mass_density(rho[e]));
  });
  g.resize(x.size());
  assemble_vertex_vector<dim>(elements_, element_vectors_, g);
}

// The blocks  V_e sum_jq S_kj H_jq S_lq  of the corners k and l, with H_jq the (dim, dim) blocks of H.
template <int dim>
void Solid<dim>::set_blocks(int e, const GradientHessian<dim>& H) const
{
  const auto& S = shape_gradients_[static_cast<std::size_t>(e)];
  auto* blocks = &element_blocks_[static_cast<std::size_t>(e) * corners * corners];
  for (int l = 0; l < corners; ++l) {
    Eigen::Matrix<double, dim * dim, dim> T = S(l, 0) * H.template leftCols<dim>();
    for (int q = 1; q < dim; ++q) T += S(l, q) * H.template middleCols<dim>(dim * q);
    T *= volumes_[e];
    for (int k = 0; k < corners; ++k) {
      auto& block = blocks[corners * l + k];
      block = S(k, 0) * T.template topRows<dim>();
      for (int j = 1; j < dim; ++j) block += S(k, j) * T.template middleRows<dim>(dim * j);
    }
  }
}

template <int dim>
void Solid<dim>::hessian(ConstVec x, ConstVec rho, Projection projection, SparseMatrix& K) const
{
  parallel_for(element_count(), [&](int e) {
    const Gradient<dim> F = deformation_gradient(x, e);
    const SolidDensity density = mixture_.density(rho[e], F.squaredNorm(), F.determinant(), Order::Hessian);
    set_blocks(e, projection == Projection::None ? stress_derivative<dim>(density, F)
                                                 : projected_stress_derivative<dim>(density, F));
  });
  pattern_.assemble(element_blocks_, K);
}

template <int dim>
void Solid<dim>::prepare_mixed(SparseMatrix& B) const
{
  if (B.rows() != mixed_zero_.rows() || B.cols() != mixed_zero_.cols() || B.nonZeros() != mixed_zero_.nonZeros())
    B = mixed_zero_;
}

template <int dim>
void Solid<dim>::set_mixed_column(int e, const Corners& forces, SparseMatrix& B) const
{
  for (int k = 0; k < corners; ++k) {
    const int rank = corner_rank_[static_cast<std::size_t>(corners * e + k)];
    Eigen::Map<Point>(B.valuePtr() + dim * (corners * e + rank)) = forces.col(k);
  }
}

template <int dim>
void Solid<dim>::mixed_hessian(ConstVec x, ConstVec rho, SparseMatrix& B) const
{
  prepare_mixed(B);
  parallel_for(element_count(), [&](int e) {
    const Gradient<dim> F = deformation_gradient(x, e);
    const SolidDensity difference = mixture_.difference(F.squaredNorm(), F.determinant(), Order::Gradient);
    Corners forces = mixture_.weight(rho[e]).first * corner_forces(e, stress<dim>(difference, F));
    forces.colwise() -= weight_per_corner(e, mixture_.mass_density_derivative());
    set_mixed_column(e, forces, B);
  });
}

// lambda . dW/dx is an element's  V P : L  with L the gradient of lambda; gravity is linear and drops out.
template <int dim>
void Solid<dim>::force_hessian(ConstVec x, ConstVec rho, ConstVec lambda, SparseMatrix& xx, SparseMatrix& mixed,
                               Vec& rho_rho) const
{
  prepare_mixed(mixed);
  rho_rho.resize(element_count());
  parallel_for(element_count(), [&](int e) {
    const Gradient<dim> F = deformation_gradient(x, e), L = deformation_gradient(lambda, e);
    const double I = F.squaredNorm(), J = F.determinant();
    const SolidDensity density = mixture_.density(rho[e], I, J, Order::Third);
    set_blocks(e, stress_derivative_change<dim>(density, F, L));
    const SolidDensity difference = mixture_.difference(I, J, Order::Hessian);
    const typename Mixture::Weight s = mixture_.weight(rho[e]);
    const GradientHessian<dim> H = stress_derivative<dim>(difference, F);
    Gradient<dim> change;
    Eigen::Map<Eigen::Matrix<double, dim * dim, 1>>(change.data()) =
        H * Eigen::Map<const Eigen::Matrix<double, dim * dim, 1>>(L.data());
    set_mixed_column(e, s.first * corner_forces(e, change), mixed);
    rho_rho[e] = s.second * volumes_[e] * stress<dim>(difference, F).cwiseProduct(L).sum();
  });
  pattern_.assemble(element_blocks_, xx);
}

template class Solid<2>;
template class Solid<3>;

}  // namespace softform
