#pragma once

#include <vector>

#include "softform/characters/boundary_normals.hpp"
#include "softform/characters/sliding_places.hpp"
#include "softform/characters/strings.hpp"
#include "softform/optimizers/nonlinear_program.hpp"

namespace softform {

struct StringPlacementWeights {
  SlidingWeights sliding;
  /// k_dir of (5.15) [mm^2]: large enough that no string of the tower runs through it, at hardly any cost in distance.
  double direction = 10;
  /// Of 1/2 tau^2 [mm^2/N^2]: two strings that draw against each other stiffen the body for little gain.
  double tension = 0.1;
};

/// Full-space programme of the second stage for strings (5.4.3): positions x^i of the poses, tensions tau^i of the
/// strings in them, the points a(s) where they leave the ring and the places l where they are tied,
///     min  1/2 sum_i |x^i - t^i|^2 + (sliding terms of l) + k_dir sum_ij (1 - d_j^i . n_j^i)^2 + w/2 sum_ij
///     (tau_j^i)^2 subject to  dW/dx(x^i) = sum_j tau_j^i w(l_j) d_j^i  and  tau >= 0,
/// where d = (a - y)/|a - y| is a string's direction from its point y = sum_m w_m(l) x_m of the body and n the
/// interpolated normal of the deformed boundary there (5.15; the printed q/|q| has no direction for a slack string).
/// Rows of coordinates that are held say that they stay at their start. The ring's points are given by arc lengths s,
/// which satisfies (5.14) exactly. z = (x^1, ..., tau^1, ..., s, l) in mm and N. Places may move by the kernels' radius
/// from where they started: beyond, all functions are NaN and restore() has nothing.
class StringPlacementProgram : public NonlinearProgram {
 public:
  /// start_positions: (2n) [m] each, whose clamped coordinates stay. The body and `posed` must outlive this object.
  StringPlacementProgram(const PosedBody& posed, const StringLayout& start, std::vector<Vec> start_positions,
                         const StringPlacementWeights& weights = {});

  std::string name() const override { return "string_placement"; }
  int variable_count() const override { return static_cast<int>(place_start()) + 2 * string_count(); }
  int constraint_count() const override { return pose_count() * state_size(); }
  Vec initial_point() const override;
  Vec lower_bounds() const override;

  double objective(ConstVec z) const override;
  void objective_gradient(ConstVec z, Vec& g) const override;
  void gauss_newton_hessian(ConstVec z, SparseMatrix& H) const override;
  void constraints(ConstVec z, Vec& c) const override;
  void constraint_jacobian(ConstVec z, SparseMatrix& J) const override;
  /// Steps are measured in the design (tau, s, l) alone.
  void step_metric(ConstVec z, SparseMatrix& D) const override;
  /// The equilibria of all poses under the strings of z, from the poses of z.
  std::optional<Vec> restore(ConstVec z) const override;

  Vec positions(ConstVec z, int pose) const;
  StringLayout layout(ConstVec z) const;
  /// Equilibria that were not found in restore().
  int failed_equilibria() const { return failed_equilibria_; }

 private:
  // A string in a pose.
  struct Line {
    std::vector<BoundaryWeight> weights;
    double tension, length;           // [N], [m]
    Point<2> direction, along_ring;   // of the string; of its end when s grows
    Eigen::Matrix2d turning, moving;  // d(direction)/da [1/m]; dy/dl
  };
  // 1 - d . n and its derivatives as a row of the residuals' Jacobian.
  struct Slant {
    double value;
    std::vector<Eigen::Triplet<double>> row;
  };

  int pose_count() const { return static_cast<int>(posed_.pose_count()); }
  int string_count() const { return start_.count(); }
  int state_size() const { return 2 * posed_.body.vertex_count(); }
  Eigen::Index tension_start(int pose) const
  {
    return Eigen::Index(pose_count()) * state_size() + Eigen::Index(pose) * string_count();
  }
  Eigen::Index arc_start() const { return tension_start(pose_count()); }
  Eigen::Index place_start() const { return arc_start() + string_count(); }
  auto places(ConstVec z) const { return z.tail(2 * Eigen::Index(string_count())); }
  bool is_held(Eigen::Index k) const { return posed_.held.free.size() > 0 && posed_.held.free[k] == 0; }
  Line line(ConstVec z, ConstVec x, int pose, int string) const;
  Slant slant(ConstVec z, ConstVec x, int pose, int string) const;
  template <class Visit>
  void for_each_slant(ConstVec z, const Visit& visit) const;
  void append_string(const Line& line, int pose, int string, std::vector<Eigen::Triplet<double>>& entries) const;

  const PosedBody& posed_;
  BoundaryField field_;
  BoundaryNormals normals_;
  SlidingPlaces sliding_;
  std::vector<Vec> start_positions_;
  StringLayout start_;
  StringPlacementWeights weights_;
  mutable SparseMatrix K_;
  mutable SparseFactorization factorization_;
  mutable int failed_equilibria_ = 0;
};

}  // namespace softform
