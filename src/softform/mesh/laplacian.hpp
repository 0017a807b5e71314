#pragma once

#include "softform/mesh/triangle_mesh.hpp"

namespace softform {

/// The stiffness matrix L (n, n) of linear elements on a surface, with cotangent weights: u . L u is the integral of
/// |grad u|^2, so that L is positive semi-definite, constants are in its kernel, and -L u / vertex_areas() approaches
/// the Laplace-Beltrami operator of u (Pinkall and Polthier 1993). Both triangles are stored.
SparseMatrix cotangent_laplacian(const TriangleMesh& mesh);

}  // namespace softform
