#pragma once

#include <array>
#include <vector>

#include "softform/core/types.hpp"

namespace softform {

/// One row an element: triangles (m, 3) counter-clockwise in the plane, tetrahedra (m, 4) of positive volume in space.
template <int dim>
using Simplices = Eigen::Matrix<int, Eigen::Dynamic, dim + 1, Eigen::RowMajor>;
using Tetrahedra = Simplices<3>;

/// A body cut into triangles of the plane or tetrahedra of space.
template <int dim>
struct SimplexMesh {
  Vec positions;  ///< (dim n) [m]
  Simplices<dim> elements;

  int vertex_count() const { return static_cast<int>(positions.size()) / dim; }
  int element_count() const { return static_cast<int>(elements.rows()); }
};

/// A rectangle or box from the origin with `cells` along its axes; each cell is cut into 2 triangles or 6 tetrahedra
/// (Kuhn 1960), neighbouring cells mirrored, so that the mesh prefers no diagonal.
template <int dim>
SimplexMesh<dim> grid(const Eigen::Matrix<double, dim, 1>& size, const std::array<int, dim>& cells);

/// A plate: a planar mesh at z = 0 and z = `thickness` [m], three tetrahedra for each triangle, those of triangle t
/// from 3 t on.
SimplexMesh<3> extruded(const SimplexMesh<2>& mesh, double thickness);

/// Faces of the boundary: edges (k, 2) of triangles, triangles (k, 3) of tetrahedra, oriented outwards, and the element
/// (k) that each belongs to.
template <int dim>
struct BoundaryFaces {
  Eigen::Matrix<int, Eigen::Dynamic, dim, Eigen::RowMajor> faces;
  std::vector<int> elements;
};
template <int dim>
BoundaryFaces<dim> boundary_faces(const Simplices<dim>& elements);

/// The vertices of the boundary, sorted.
template <int dim>
std::vector<int> boundary_vertices(const Simplices<dim>& elements);

/// The elements that share a face with each element.
template <int dim>
std::vector<std::vector<int>> element_neighbours(const Simplices<dim>& elements);

}  // namespace softform
