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

using Mat9 = Eigen::Matrix<double, 9, 9>;

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
  element_matrices_.resize(count * 81);
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
    const Eigen::Matrix<double, 3, 9> J = deformed.jacobian();
    Eigen::Map<Mat9> H(&element_matrices_[static_cast<std::size_t>(t) * 81]);
    H.noalias() = J.transpose() * (element.hessian.topLeftCorner<3, 3>() * J);
    const Eigen::Matrix3d pairs = TriangleEdges::second_derivative(element.gradient.head<3>());
    for (int c = 0; c < 3; ++c)
      for (int r = 0; r < 3; ++r) H.block<3, 3>(3 * r, 3 * c).diagonal().array() += pairs(r, c);
  });
  pattern_.assemble(element_matrices_, K);
}

void Membrane::mixed_hessian(ConstVec x, ConstVec rest_positions, SparseMatrix& B) const
{
  const int count = static_cast<int>(triangles_.rows());
  parallel_for(count, [&](int t) {
    MembraneElement element;
    const TriangleEdges deformed = edges(x, triangles_, t);
    const TriangleEdges rest = edges(rest_positions, triangles_, t);
    evaluate_membrane_element(*material_, thickness_[t], deformed.products(), rest.products(), Order::Hessian, element);
    Eigen::Map<Mat9> M(&element_matrices_[static_cast<std::size_t>(t) * 81]);
    M.noalias() = deformed.jacobian().transpose() * (element.hessian.topRightCorner<3, 3>() * rest.jacobian());
  });
  pattern_.assemble(element_matrices_, B);
}

double Membrane::mean_stretch(ConstVec x, ConstVec rest_positions) const
{
  return std::sqrt(surface_area(x, triangles_) / surface_area(rest_positions, triangles_));
}

}  // namespace softform
