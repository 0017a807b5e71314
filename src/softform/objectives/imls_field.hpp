#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "softform/mesh/triangle_mesh.hpp"

namespace softform {

/// Points of a surface with what they weigh around them.
struct ImlsKernels {
  Positions centres;  ///< c_k (n, 3) [m]
  Positions normals;  ///< n_k (n, 3), of unit length, outwards
  double radius;      ///< h of the kernels [m]
};

/// The signed distance to a surface by implicit moving least squares (6.17; Öztireli et al. 2009), positive outside:
///     d(x) = N / S,   N = sum_k phi_k(x) n_k . (x - c_k),   S = sum_k phi_k(x),
///     phi_k(x) = (1 - |x - c_k|^2 / h^2)^4 for |x - c_k| < h, and zero beyond.
/// It is off the true distance by some h^2 / 12 R outwards on a surface of radius R. That is for points that kernels
/// reach: where they fade, with S under 0.3, wider kernels with a field D take over,
///     d = (N + w D) / (S + w),   w = (1 - S / 0.3)^4,
/// and so on to the widest, beyond which d is the signed distance to the closest centre. As far as kernels reach d has
/// three continuous derivatives: an optimisation that is still far from its target sees no edge of the kernels.
/// Queries may run in parallel.
class ImlsField {
 public:
  /// Kernels from the narrowest, which tell the distance near the surface, to the widest. Precondition: not empty.
  explicit ImlsField(std::vector<ImlsKernels> levels);
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

  /// Of the narrowest kernels [m].
  double radius() const;

 private:
  struct Level;
  Value evaluate(const Vec3& x, Derivatives derivatives, std::size_t level) const;
  Value nearest(const Vec3& x, Derivatives derivatives) const;

  std::vector<std::unique_ptr<const Level>> levels_;
};

/// The field of a surface from `count` centres spread evenly over it, with normals interpolated between its vertices
/// and kernels that reach three times as far as centres are apart: the thesis has a kernel at every vertex of the
/// target, which wants an even mesh, and a bias that a finer one would not have. Wider kernels, twice and so on up to
/// about the size of the surface, are around a quarter as many centres each.
ImlsField imls_field(const TriangleMesh& surface, int count = 10'000);

}  // namespace softform
