#include "softform/fem/membrane.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <fmt/format.h>

#include "softform/core/error.hpp"
#include "softform/core/parallel.hpp"
#include "softform/materials/tension_field.hpp"

namespace softform {
namespace {

using Mat39 = Eigen::Matrix<double, 3, 9>;
template <int rows, int columns>
using Blocks = std::vector<Eigen::Matrix<double, rows, columns>>;

// The element matrix L^t R + pairs (x) I, block by block.
template <int rows, int columns>
void set_blocks(int t, const Eigen::Matrix<double, 3, 3 * rows>& L, const Eigen::Matrix<double, 3, 3 * columns>& R,
                const Eigen::Matrix3d& pairs, Blocks<rows, columns>& blocks)
{
  for (int c = 0; c < 3; ++c) {
    for (int r = 0; r < 3; ++r) {
      auto& block = blocks[static_cast<std::size_t>(9 * t + 3 * c + r)];
      block.noalias() = L.template middleCols<rows>(rows * r).transpose() * R.template middleCols<columns>(columns * c);
      block.diagonal().array() += pairs(r, c);
    }
  }
}

template <int rows, int columns>
void add_blocks(int t, const Eigen::Matrix<double, 3, 3 * rows>& L, const Eigen::Matrix<double, 3, 3 * columns>& R,
                Blocks<rows, columns>& blocks)
{
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r)
      blocks[static_cast<std::size_t>(9 * t + 3 * c + r)] +=
          L.template middleCols<rows>(rows * r).transpose() * R.template middleCols<columns>(columns * c);
}

// A with its negative eigenvalues cut to zero.
template <class Matrix>
Matrix positive_part(const Matrix& A)
{
  const Eigen::SelfAdjointEigenSolver<Matrix> modes(A);
  return modes.eigenvectors() * modes.eigenvalues().cwiseMax(0).asDiagonal() * modes.eigenvectors().transpose();
}

// The weights dW/d(uu, uv, vv) of the stress without its compression, in an orthonormal frame of the rest triangle.
Vec3 tension(const Vec3& weights, const EdgeProducts& rest)
{
  Eigen::Matrix2d S, metric;
  S << weights[0], weights[1] / 2, weights[1] / 2, weights[2];
  metric << rest.uu, rest.uv, rest.uv, rest.vv;
  const Eigen::Matrix2d L = metric.llt().matrixL();
  const Eigen::Matrix2d L_inverse = L.inverse();
  const Eigen::Matrix2d T = L_inverse.transpose() * positive_part<Eigen::Matrix2d>(L.transpose() * S * L) * L_inverse;
  return {T(0, 0), 2 * T(0, 1), T(1, 1)};
}

}  // namespace

template <int k>
MembraneOf<k>::MembraneOf(Triangles triangles, int vertex_count, Triangles rest_triangles, int rest_vertex_count,
                          std::shared_ptr<const Material> material, Vec thickness)
    : triangles_(std::move(triangles)),
      vertex_count_(vertex_count),
      rest_triangles_(std::move(rest_triangles)),
      rest_vertex_count_(rest_vertex_count),
      material_(std::move(material)),
      thickness_(std::move(thickness)),
      pattern_(triangles_, vertex_count),
      mixed_pattern_(triangles_, vertex_count, rest_triangles_, rest_vertex_count),
      rest_pattern_(rest_triangles_, rest_vertex_count)
{
  if (thickness_.size() != triangles_.rows())
    throw InputError(
        fmt::format("{} thicknesses for {} triangles: give one each", thickness_.size(), triangles_.rows()));
  for (int t = 0; t < thickness_.size(); ++t)
    if (!(thickness_[t] > 0) || !std::isfinite(thickness_[t]))
      throw InputError(fmt::format("triangle {} has the thickness {} m: it must be positive", t, thickness_[t]));
  const auto count = static_cast<std::size_t>(triangles_.rows());
  element_scalars_.resize(count);
  element_vectors_.resize(count * 9);
  element_blocks_.resize(count * 9);
}

template <int k>
TriangleEdges MembraneOf<k>::deformed_edges(ConstVec x, int t) const
{
  return {x, triangles_(t, 0), triangles_(t, 1), triangles_(t, 2)};
}

template <int k>
EdgesOf<k> MembraneOf<k>::rest_edges(ConstVec rest_positions, int t) const
{
  return {rest_positions, rest_triangles_(t, 0), rest_triangles_(t, 1), rest_triangles_(t, 2)};
}

template <int k>
double MembraneOf<k>::value(ConstVec x, ConstVec rest_positions) const
{
  const int count = static_cast<int>(triangles_.rows());
  parallel_for(count, [&](int t) {
    MembraneElement element;
    evaluate_membrane_element(*material_, thickness_[t], deformed_edges(x, t).products(),
                              rest_edges(rest_positions, t).products(), Order::Value, element);
    element_scalars_[static_cast<std::size_t>(t)] = element.energy;
  });
  double sum = 0;
  for (double energy : element_scalars_) sum += energy;
  return sum;
}

// evaluate: (triangle, deformed edge products, element) fills the element's gradient.
template <int k>
template <class Evaluate>
void MembraneOf<k>::assemble_gradient(ConstVec x, const Evaluate& evaluate, Vec& g) const
{
  const int count = static_cast<int>(triangles_.rows());
  parallel_for(count, [&](int t) {
    MembraneElement element;
    const TriangleEdges deformed = deformed_edges(x, t);
    evaluate(t, deformed.products(), element);
    Eigen::Map<Eigen::Matrix<double, 9, 1>> forces(&element_vectors_[static_cast<std::size_t>(t) * 9]);
    forces = deformed.jacobian().transpose() * element.gradient.template head<3>();
  });
  g.resize(3 * vertex_count_);
  assemble_vector(triangles_, element_vectors_, g);
}

template <int k>
void MembraneOf<k>::gradient(ConstVec x, ConstVec rest_positions, Vec& g) const
{
  const auto evaluate = [&](int t, const EdgeProducts& deformed, MembraneElement& element) {
    evaluate_membrane_element(*material_, thickness_[t], deformed, rest_edges(rest_positions, t).products(),
                              Order::Gradient, element);
  };
  assemble_gradient(x, evaluate, g);
}

template <int k>
void MembraneOf<k>::rest_gradient(ConstVec x, ConstVec rest_positions, Vec& g) const
{
  g.setZero(k * rest_vertex_count_);
  for (int t = 0; t < triangles_.rows(); ++t) {
    MembraneElement element;
    const EdgesOf<k> rest = rest_edges(rest_positions, t);
    evaluate_membrane_element(*material_, thickness_[t], deformed_edges(x, t).products(), rest.products(),
                              Order::Gradient, element);
    const Eigen::Matrix<double, 3 * k, 1> forces = rest.jacobian().transpose() * element.gradient.template tail<3>();
    for (int i = 0; i < 3; ++i) g.template segment<k>(k * rest_triangles_(t, i)) += forces.template segment<k>(k * i);
  }
}

template <int k>
void MembraneOf<k>::parameter_gradient(ConstVec x, ConstVec rest_positions, int parameter, Vec& g) const
{
  const auto evaluate = [&](int t, const EdgeProducts& deformed, MembraneElement& element) {
    evaluate_parameter_derivative(*material_, parameter, thickness_[t], deformed,
                                  rest_edges(rest_positions, t).products(), Order::Gradient, element);
  };
  assemble_gradient(x, evaluate, g);
}

template <int k>
void MembraneOf<k>::hessian(ConstVec x, ConstVec rest_positions, SparseMatrix& K) const
{
  const int count = static_cast<int>(triangles_.rows());
  parallel_for(count, [&](int t) {
    MembraneElement element;
    const TriangleEdges deformed = deformed_edges(x, t);
    evaluate_membrane_element(*material_, thickness_[t], deformed.products(), rest_edges(rest_positions, t).products(),
                              Order::Hessian, element);
    const Mat39 J = deformed.jacobian();
    const Eigen::Matrix3d pairs = TriangleEdges::second_derivative(element.gradient.template head<3>());
    set_blocks<3, 3>(t, J, element.hessian.template topLeftCorner<3, 3>() * J, pairs, element_blocks_);
  });
  pattern_.assemble(element_blocks_, K);
}

template <int k>
bool MembraneOf<k>::projected_hessian(ConstVec x, ConstVec rest_positions, SparseMatrix& K) const
{
  const int count = static_cast<int>(triangles_.rows());
  parallel_for(count, [&](int t) {
    MembraneElement element;
    const TriangleEdges deformed = deformed_edges(x, t);
    const EdgeProducts rest = rest_edges(rest_positions, t).products();
    evaluate_membrane_element(*material_, thickness_[t], deformed.products(), rest, Order::Hessian, element);
    const Mat39 J = deformed.jacobian();
    const Vec3 stress = element.gradient.template head<3>(), pull = tension(stress, rest);
    const Eigen::Matrix3d moduli = positive_part<Eigen::Matrix3d>(element.hessian.template topLeftCorner<3, 3>());
    set_blocks<3, 3>(t, J, moduli * J, TriangleEdges::second_derivative(pull), element_blocks_);
    element_scalars_[static_cast<std::size_t>(t)] = (pull - stress).norm() / stress.norm();
  });
  if (!(*std::max_element(element_scalars_.begin(), element_scalars_.end()) > 1e-6)) return false;
  pattern_.assemble(element_blocks_, K);
  return true;
}

template <int k>
void MembraneOf<k>::mixed_hessian(ConstVec x, ConstVec rest_positions, SparseMatrix& B) const
{
  const int count = static_cast<int>(triangles_.rows());
  Blocks<3, k> blocks(element_blocks_.size());
  parallel_for(count, [&](int t) {
    MembraneElement element;
    const TriangleEdges deformed = deformed_edges(x, t);
    const EdgesOf<k> rest = rest_edges(rest_positions, t);
    evaluate_membrane_element(*material_, thickness_[t], deformed.products(), rest.products(), Order::Hessian, element);
    set_blocks<3, k>(t, deformed.jacobian(), element.hessian.template topRightCorner<3, 3>() * rest.jacobian(),
                     Eigen::Matrix3d::Zero(), blocks);
  });
  mixed_pattern_.assemble(blocks, B);
}

// With s_k = lambda . dq_k/dx, linear in x:  lambda . dW/dx = sum_k W_k s_k  over the three deformed dot products.
template <int k>
void MembraneOf<k>::force_hessian(ConstVec x, ConstVec rest_positions, ConstVec lambda, SparseMatrix& xx,
                                  SparseMatrix& mixed, SparseMatrix& XX) const
{
  const int count = static_cast<int>(triangles_.rows());
  Blocks<3, k> blocks_mixed(element_blocks_.size());
  Blocks<k, k> blocks_XX(element_blocks_.size());
  parallel_for(count, [&](int t) {
    const TriangleEdges deformed = deformed_edges(x, t), change = deformed_edges(lambda, t);
    const EdgesOf<k> rest = rest_edges(rest_positions, t);
    const Vec3 s(2 * deformed.u.dot(change.u), deformed.u.dot(change.v) + deformed.v.dot(change.u),
                 2 * deformed.v.dot(change.v));
    MembraneElement element;
    evaluate_membrane_element(*material_, thickness_[t], deformed.products(), rest.products(), Order::Hessian, element);
    const Eigen::Matrix<double, 6, 6> T =
        contracted_third_derivative(*material_, thickness_[t], deformed.products(), rest.products(), s);
    const Eigen::Matrix<double, 6, 1> v = element.hessian.leftCols<3>() * s;
    const Mat39 J = deformed.jacobian(), J_lambda = change.jacobian();
    const Eigen::Matrix<double, 3, 3 * k> J_rest = rest.jacobian();
    const Eigen::Matrix3d H_xx = element.hessian.topLeftCorner<3, 3>(),
                          H_x_rest = element.hessian.topRightCorner<3, 3>();
    set_blocks<3, 3>(t, J, T.topLeftCorner<3, 3>() * J + H_xx * J_lambda, TriangleEdges::second_derivative(v.head<3>()),
                     element_blocks_);
    add_blocks<3, 3>(t, J_lambda, H_xx * J, element_blocks_);
    set_blocks<3, k>(t, J, T.topRightCorner<3, 3>() * J_rest, Eigen::Matrix3d::Zero(), blocks_mixed);
    add_blocks<3, k>(t, J_lambda, H_x_rest * J_rest, blocks_mixed);
    set_blocks<k, k>(t, J_rest, T.bottomRightCorner<3, 3>() * J_rest, EdgesOf<k>::second_derivative(v.tail<3>()),
                     blocks_XX);
  });
  pattern_.assemble(element_blocks_, xx);
  mixed_pattern_.assemble(blocks_mixed, mixed);
  rest_pattern_.assemble(blocks_XX, XX);
}

template <int k>
double MembraneOf<k>::mean_stretch(ConstVec x, ConstVec rest_positions) const
{
  double deformed = 0, rest = 0;
  for (int t = 0; t < triangles_.rows(); ++t) {
    deformed += deformed_edges(x, t).products().area();
    rest += rest_edges(rest_positions, t).products().area();
  }
  return std::sqrt(deformed / rest);
}

template <int k>
Eigen::MatrixX2d MembraneOf<k>::principal_stretches(ConstVec x, ConstVec rest_positions) const
{
  Eigen::MatrixX2d stretches(triangles_.rows(), 2);
  for (int t = 0; t < triangles_.rows(); ++t) {
    const CauchyGreenInvariants C =
        cauchy_green_invariants(deformed_edges(x, t).products(), rest_edges(rest_positions, t).products());
    const SquaredStretches lambda = SquaredStretches::of(C.t, C.d);
    stretches.row(t) << std::sqrt(lambda.lambda_1), std::sqrt(lambda.lambda_2);
  }
  return stretches;
}

template class MembraneOf<2>;
template class MembraneOf<3>;

}  // namespace softform
