#pragma once

#include <algorithm>
#include <cmath>

#include "softform/mesh/simplex_mesh.hpp"

/// Bodies of simple shape for tests.
namespace softform::testing {

/// A square or cube of edge `size`, `cells` a side, its inner vertices moved off the grid so that no two elements are
/// alike.
template <int dim>
SimplexMesh<dim> uneven_block(double size, int cells)
{
  std::array<int, dim> counts;
  counts.fill(cells);
  SimplexMesh<dim> mesh = grid<dim>(Eigen::Matrix<double, dim, 1>::Constant(size), counts);
  const double spacing = size / cells;
  for (int i = 0; i < mesh.vertex_count(); ++i) {
    auto X = mesh.positions.template segment<dim>(dim * i);
    const bool is_inner = X.minCoeff() > 0.1 * spacing && X.maxCoeff() < size - 0.1 * spacing;
    for (int a = 0; is_inner && a < dim; ++a) X[a] += 0.15 * spacing * std::sin(3.0 * i + 2 * a);
  }
  return mesh;
}

}  // namespace softform::testing
