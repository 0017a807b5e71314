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

void Membrane::gradient(ConstVec x, ConstVec rest_positions, Vec& g) const
{
  const int count = static_cast<int>(triangles_.rows());
  parallel_for(count, [&](int t) {
    MembraneElement element;
    const TriangleEdges deformed = edges(x, triangles_, t);
    evaluate_membrane_element(*material_, thickness_[t], deformed.products(),
                              edges(rest_positions, triangles_, t).products(), Order::Gradient, element);
    Eigen::Map<Eigen::Matrix<double, 9, 1>> forces(&element_vectors_[static_cast<std::size_t>(t) * 9]);
    forces = deformed.jacobian().transpose() * element.gradient.head<3>();
  });
  g.resize(3 * vertex_count_);
  assemble_vector(triangles_, element_vectors_, g);
}

// The element matrix L^t R + pairs (x) I, block by block.
void Membrane::set_blocks(int t, const Mat39& L, const Mat39& R, const Eigen::Matrix3d& pairs) const
{
  for (int c = 0; c < 3; ++c) {
    for (int r = 0; r < 3; ++r) {
      Eigen::Matrix3d& block = element_blocks_[static_cast<std::size_t>(9 * t + 3 * c + r)];
      block.noalias() = L.middleCols<3>(3 * r).transpose() * R.middleCols<3>(3 * c);
      block.diagonal().array() += pairs(r, c);
    }
  }
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
    set_blocks(t, J, element.hessian.topLeftCorner<3, 3>() * J, pairs);
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
    set_blocks(t, J, element.hessian.topRightCorner<3, 3>() * rest.jacobian(), Eigen::Matrix3d::Zero());
  });
  pattern_.assemble(element_blocks_, B);
}

double Membrane::mean_stretch(ConstVec x, ConstVec rest_positions) const
{
  return std::sqrt(surface_area(x, triangles_) / surface_area(rest_positions, triangles_));
}

}  // namespace softform
