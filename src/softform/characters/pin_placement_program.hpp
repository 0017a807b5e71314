#pragma once

#include <vector>

#include "softform/characters/sliding_places.hpp"
#include "softform/equilibrium/loaded_solid.hpp"
#include "softform/optimizers/nonlinear_program.hpp"

namespace softform {

/// Pins: where they sit on the boundary at rest, the side of the body that each belongs to, and where they are held in
/// each pose.
struct Pins {
  std::vector<Point<2>> places;                  ///< (pins) [m]
  std::vector<Point<2>> sides;                   ///< outward unit normals (pins)
  std::vector<std::vector<Point<2>>> positions;  ///< by pose and pin [m]

  int count() const { return static_cast<int>(places.size()); }
};

struct PinPlacementWeights {
  /// A pin holds its point of the body like a spring of this stiffness [N/m]: stiff against the body, so that the
  /// position is what counts, soft against round-off.
  double stiffness = 5e4;
  double boundary = 10;     ///< of (5.11), Phi in mm
  double repulsion = 1e-2;  ///< k_rep of (5.13), lengths in mm
};

/// Full-space programme of the second stage (5.4.3): positions x^i of the poses, positions y^i of the pins in them and
/// the pins' places l on the boundary,
///     min  1/2 sum_i |x^i - t^i|^2 + w_b/2 sum_j Phi(l_j)^2 + k_rep sum_{jk} [eps - |l_j - l_k|]_+^3
///     subject to  dW/dx(x^i) + k sum_j w(l_j) (sum_m w_m(l_j) x_m^i - y_j^i) = 0,
/// where the rows of coordinates that are held say k (x_k^i - X_k) = 0 instead.
/// Pins act by position rather than by force: dead loads let a body snap. z = (x^1, ..., y^1, ..., l) in mm. Places may
/// move by the kernels' radius from where they started: beyond, all functions are NaN and restore() has nothing.
class PinPlacementProgram : public NonlinearProgram {
 public:
  /// targets: (2n) [m] each; densities (m). The body must outlive this object.
  PinPlacementProgram(const PlanarSolid& body, Vec densities, std::vector<Vec> targets, const Pins& start,
                      std::vector<Vec> start_positions, const PinPlacementWeights& weights = {}, FixedDofs held = {});

  std::string name() const override { return "pin_placement"; }
  int variable_count() const override { return pose_count() * (state_size() + pin_size()) + pin_size(); }
  int constraint_count() const override { return pose_count() * state_size(); }
  Vec initial_point() const override;

  double objective(ConstVec z) const override;
  void objective_gradient(ConstVec z, Vec& g) const override;
  void gauss_newton_hessian(ConstVec z, SparseMatrix& H) const override;
  void constraints(ConstVec z, Vec& c) const override;
  void constraint_jacobian(ConstVec z, SparseMatrix& J) const override;
  /// The equilibria of all poses under the pins of z, from the poses of z.
  std::optional<Vec> restore(ConstVec z) const override;

  Vec positions(ConstVec z, int pose) const;
  Pins pins(ConstVec z) const;
  /// Equilibria that were not found in restore().
  int failed_equilibria() const { return failed_equilibria_; }

 private:
  int pose_count() const { return static_cast<int>(targets_.size()); }
  int state_size() const { return 2 * body_.vertex_count(); }
  int pin_size() const { return 2 * start_.count(); }
  Eigen::Index pin_start(int pose) const { return Eigen::Index(pose_count()) * state_size() + pose * pin_size(); }
  Point<2> place(ConstVec z, int pin) const;
  Point<2> held_at(ConstVec z, int pose, int pin) const;
  LoadedSolid<2> loaded(ConstVec z, int pose) const;
  bool is_held(Eigen::Index k) const { return held_.free.size() > 0 && held_.free[k] == 0; }

  const PlanarSolid& body_;
  SlidingPlaces places_;
  Vec densities_;
  std::vector<Vec> targets_, start_positions_;
  Pins start_;
  PinPlacementWeights weights_;
  FixedDofs held_;
  mutable SparseMatrix K_;
  mutable SparseFactorization factorization_;
  mutable int failed_equilibria_ = 0;
};

}  // namespace softform
