#pragma once

#include <memory>

#include "softform/mesh/triangle_mesh.hpp"

namespace softform {

/// The signed distance to a surface by implicit moving least squares (6.17; Öztireli et al. 2009), positive outside:
///     d(x) = sum_k phi_k(x) n_k . (x - c_k) / sum_k phi_k(x),   phi_k(x) = (1 - |x - c_k|^2 / h^2)^4 for |x - c_k| < h
/// and zero beyond. It is smooth where kernels reach, and off the true distance by some h^2 / 12 R outwards on a
/// surface of radius R. Where no kernel reaches it is the signed distance to the closest centre. Queries may run in
/// parallel.
class ImlsField {
 public:
  /// Centres c_k (n, 3) [m], unit normals n_k (n, 3) and the kernels' radius h [m].
  ImlsField(Positions centres, Positions normals, double radius);
  ImlsField(ImlsField&&) noexcept;
  ~ImlsField();

  struct Value {
    double distance = 0;      ///< [m]
    Vec3 gradient;            ///< [1]
    Eigen::Matrix3d hessian;  ///< [1/m]
  };
  /// With the Hessian or, cheaper, without: then it is not filled in.
  enum class Derivatives { First, Second };
  Value evaluate(const Vec3& x, Derivatives derivatives) const;

  double radius() const { return radius_; }

 private:
  struct Tree;
  Value nearest(const Vec3& x, Derivatives derivatives) const;

  Positions centres_, normals_;
  double radius_;
  std::unique_ptr<Tree> tree_;
};

/// The field of a surface from `count` centres spread evenly over it, with normals interpolated between its vertices
/// and kernels that reach three times as far as centres are apart: the thesis has a kernel at every vertex of the
/// target, which wants an even mesh, and a bias that a finer one would not have.
ImlsField imls_field(const TriangleMesh& surface, int count = 10'000);

}  // namespace softform
