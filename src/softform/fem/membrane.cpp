#include "softform/fem/membrane.hpp"

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "softform/core/error.hpp"
#include "softform/core/parallel.hpp"
#include "softform/fem/membrane_element.hpp"
#include "softform/mesh/triangle_mesh.hpp"

namespace softform {
namespace {

using Mat39 = Eigen::Matrix<double, 3, 9>;

TriangleEdges edges(ConstVec x, const Triangles& triangles, int t)
{
  return {x, triangles(t, 0), triangles(t, 1), triangles(t, 2)};
}

using Blocks = std::vector<Eigen::Matrix3d>;

// The element matrix L^t R + pairs (x) I, block by block.
void set_blocks(int t, const Mat39& L, const Mat39& R, const Eigen::Matrix3d& pairs, Blocks& blocks)
{
  for (int c = 0; c < 3; ++c) {
    for (int r = 0; r < 3; ++r) {
      Eigen::Matrix3d& block = blocks[static_cast<std::size_t>(9 * t + 3 * c + r)];
      block.noalias() = L.middleCols<3>(3 * r).transpose() * R.middleCols<3>(3 * c);
      block.diagonal().array() += pairs(r, c);
    }
  }
}

void add_blocks(int t, const Mat39& L, const Mat39& R, Blocks& blocks)
{
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r)
      blocks[static_cast<std::size_t>(9 * t + 3 * c + r)] +=
          L.middleCols<3>(3 * r).transpose() * R.middleCols<3>(3 * c);
}

}  // namespace

Membrane::Membrane(Triangles triangles, int vertex_count, std::shared_ptr<const Material> material, Vec thickness)
    : triangles_(std::move(triangles)),
      vertex_count_(vertex_count),
      material_(std::move(material)),
      thickness_(std::move(thickness)),
      pattern_(triangles_, vertex_count)
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

double Membrane::value(ConstVec x, ConstVec rest_positions) const
{
  const int count = static_cast<int>(triangles_.rows());
  parallel_for(count, [&](int t) {
    MembraneElement element;
    evaluate_membrane_element(*material_, thickness_[t], edges(x, triangles_, t).products(),
                              edges(rest_positions, triangles_, t).products(), Order::Value, element);
    element_scalars_[static_cast<std::size_t>(t)] = element.energy;
  });
  double sum = 0;
  for (double energy : element_scalars_) sum += energy;
  return sum;
}

// evaluate: (triangle, deformed edge products, element) fills the element's gradient.
template <class Evaluate>
void Membrane::assemble_gradient(ConstVec x, const Evaluate& evaluate, Vec& g) const
{
  const int count = static_cast<int>(triangles_.rows());
  parallel_for(count, [&](int t) {
    MembraneElement element;
    const TriangleEdges deformed = edges(x, triangles_, t);
    evaluate(t, deformed.products(), element);
    Eigen::Map<Eigen::Matrix<double, 9, 1>> forces(&element_vectors_[static_cast<std::size_t>(t) * 9]);
    forces = deformed.jacobian().transpose() * element.gradient.head<3>();
  });
  g.resize(3 * vertex_count_);
  assemble_vector(triangles_, element_vectors_, g);
}

void Membrane::gradient(ConstVec x, ConstVec rest_positions, Vec& g) const
{
  const auto evaluate = [&](int t, const EdgeProducts& deformed, MembraneElement& element) {
    evaluate_membrane_element(*material_, thickness_[t], deformed, edges(rest_positions, triangles_, t).products(),
                              Order::Gradient, element);
  };
  assemble_gradient(x, evaluate, g);
}

void Membrane::parameter_gradient(ConstVec x, ConstVec rest_positions, int parameter, Vec& g) const
{
  const auto evaluate = [&](int t, const EdgeProducts& deformed, MembraneElement& element) {
    evaluate_parameter_derivative(*material_, parameter, thickness_[t], deformed,
                                  edges(rest_positions, triangles_, t).products(), Order::Gradient, element);
  };
  assemble_gradient(x, evaluate, g);
}

void Membrane::hessian(ConstVec x, ConstVec rest_positions, SparseMatrix& K) const
{
  const int count = static_cast<int>(triangles_.rows());
  parallel_for(count, [&](int t) {
    MembraneElement element;
    const TriangleEdges deformed = edges(x, triangles_, t);
    evaluate_membrane_element(*material_, thickness_[t], deformed.products(),
                              edges(rest_positions, triangles_, t).products(), Order::Hessian, element);
    const Mat39 J = deformed.jacobian();
    const Eigen::Matrix3d pairs = TriangleEdges::second_derivative(element.gradient.head<3>());
    set_blocks(t, J, element.hessian.topLeftCorner<3, 3>() * J, pairs, element_blocks_);
  });
  pattern_.assemble(element_blocks_, K);
}

void Membrane::mixed_hessian(ConstVec x, ConstVec rest_positions, SparseMatrix& B) const
{
  const int count = static_cast<int>(triangles_.rows());
  parallel_for(count, [&](int t) {
    MembraneElement element;
    const TriangleEdges deformed = edges(x, triangles_, t);
    const TriangleEdges rest = edges(rest_positions, triangles_, t);
    evaluate_membrane_element(*material_, thickness_[t], deformed.products(), rest.products(), Order::Hessian, element);
    const Mat39 J = deformed.jacobian();
    set_blocks(t, J, element.hessian.topRightCorner<3, 3>() * rest.jacobian(), Eigen::Matrix3d::Zero(),
               element_blocks_);
  });
  pattern_.assemble(element_blocks_, B);
}

// With s_k = lambda . dq_k/dx, linear in x:  lambda . dW/dx = sum_k W_k s_k  over the three deformed dot products.
void Membrane::force_hessian(ConstVec x, ConstVec rest_positions, ConstVec lambda, SparseMatrix& xx,
                             SparseMatrix& mixed, SparseMatrix& XX) const
{
  const int count = static_cast<int>(triangles_.rows());
  std::vector<Eigen::Matrix3d> blocks_mixed(element_blocks_.size()), blocks_XX(element_blocks_.size());
  parallel_for(count, [&](int t) {
    const TriangleEdges deformed = edges(x, triangles_, t), rest = edges(rest_positions, triangles_, t);
    const TriangleEdges change = edges(lambda, triangles_, t);
    const Vec3 s(2 * deformed.u.dot(change.u), deformed.u.dot(change.v) + deformed.v.dot(change.u),
                 2 * deformed.v.dot(change.v));
    MembraneElement element;
    evaluate_membrane_element(*material_, thickness_[t], deformed.products(), rest.products(), Order::Hessian, element);
    const Eigen::Matrix<double, 6, 6> T =
        contracted_third_derivative(*material_, thickness_[t], deformed.products(), rest.products(), s);
    const Eigen::Matrix<double, 6, 1> v = element.hessian.leftCols<3>() * s;
    const Mat39 J = deformed.jacobian(), J_rest = rest.jacobian(), J_lambda = change.jacobian();
    const Eigen::Matrix3d H_xx = element.hessian.topLeftCorner<3, 3>();
    const Mat39 R = T.topLeftCorner<3, 3>() * J + H_xx * J_lambda, R_lambda = H_xx * J;
    const Mat39 R_mixed = T.topRightCorner<3, 3>() * J_rest,
                R_lambda_mixed = element.hessian.topRightCorner<3, 3>() * J_rest;
    const Mat39 R_XX = T.bottomRightCorner<3, 3>() * J_rest;
    set_blocks(t, J, R, TriangleEdges::second_derivative(v.head<3>()), element_blocks_);
    add_blocks(t, J_lambda, R_lambda, element_blocks_);
    set_blocks(t, J, R_mixed, Eigen::Matrix3d::Zero(), blocks_mixed);
    add_blocks(t, J_lambda, R_lambda_mixed, blocks_mixed);
    set_blocks(t, J_rest, R_XX, TriangleEdges::second_derivative(v.tail<3>()), blocks_XX);
  });
  pattern_.assemble(element_blocks_, xx);
  pattern_.assemble(blocks_mixed, mixed);
  pattern_.assemble(blocks_XX, XX);
}

double Membrane::mean_stretch(ConstVec x, ConstVec rest_positions) const
{
  return std::sqrt(surface_area(x, triangles_) / surface_area(rest_positions, triangles_));
}

}  // namespace softform
