#pragma once

#include <array>
#include <vector>

#include "softform/core/types.hpp"
#include "softform/mesh/triangle_mesh.hpp"
#include "softform/objectives/objective.hpp"

namespace softform {

/// Weights of the two terms of (4.12), dimensionless.
struct EdgeDihedralWeights {
  double stretch = 1;    ///< k_l
  double bending = 0.1;  ///< k_b per square radian; as large as k_l it makes the optimum rough
};

/// The distance energy (4.12) between a surface x and a target surface of the same connectivity,
///     E_d = sum_e [ k_l (1 - l_e / l_e^0)^2 + k_b (theta_e - theta_e^0)^2 ] l_e^0 / sum_e l_e^0,
/// divided by the sum of l_e^0 so that it is dimensionless and independent of the mesh's fineness. Local deviations
/// stay local: it sees edge lengths and dihedral angles, not positions.
class EdgeDihedralDistance : public Objective {
 public:
  /// target_positions: (3n) [m], whose lengths l^0 and angles theta^0 are matched.
  EdgeDihedralDistance(const Triangles& triangles, ConstVec target_positions, EdgeDihedralWeights weights = {});

  /// Matches other positions from now on (3n) [m]; the pattern stays.
  void set_target(ConstVec target_positions);

  double value(ConstVec x) const override;
  void gradient(ConstVec x, Vec& g) const override;
  void gauss_newton_hessian(ConstVec x, SparseMatrix& H) const override;
  bool hessian(ConstVec x, SparseMatrix& H) const override;

 private:
  using Mat12 = Eigen::Matrix<double, 12, 12>;
  struct Flap {
    int start, end, left, right;   // right = -1 on a boundary, which has no angle
    double length, angle, weight;  // of the target; weight l^0 / sum l^0
  };
  /// Sums element_of(flap, its positions a, b, c, d) (12, 12) into H; d = c on a boundary.
  template <class ElementOf>
  void assemble(ConstVec x, const ElementOf& element_of, SparseMatrix& H) const;
  Mat12 gauss_newton_element(const Flap& flap, const std::array<Vec3, 4>& corners) const;
  Mat12 curvature_element(const Flap& flap, const std::array<Vec3, 4>& corners) const;

  std::vector<Flap> flaps_;
  EdgeDihedralWeights weights_;
  SparseMatrix pattern_;
  std::vector<int> slots_;  // where the 16 blocks of each flap start in the values: see gauss_newton_hessian
};

/// The signed dihedral angle at the edge (a, b) between the triangles (a, b, c) and (b, a, d) [rad]: 0 when flat,
/// positive when the edge is convex as seen from the triangles' outside.
double dihedral_angle(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// Derivative of dihedral_angle in (a, b, c, d) (12) [1/m].
Eigen::Matrix<double, 12, 1> dihedral_gradient(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// Second derivative of dihedral_angle in (a, b, c, d) (12, 12) [1/m^2].
Eigen::Matrix<double, 12, 12> dihedral_hessian(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

}  // namespace softform
