#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "softform/core/report.hpp"
#include "softform/equilibrium/loaded_solid.hpp"

namespace softform {

/// A pose that the body has to take: what holds it, and where its vertices should come to lie.
template <int dim>
struct MaterialPose {
  Vec target;       ///< (dim n) [m]
  Vec start;        ///< (dim n) a state near equilibrium; held coordinates have their final values [m]
  FixedDofs fixed;  ///< the clamps
  Vec dead_loads;   ///< (dim n) [N], or empty
  std::vector<Pin<dim>> pins;
  std::vector<String<dim>> strings;
  /// Whether the pins' positions are designed with the material.
  bool are_pins_free = false;
};

/// Throws InputError when a pose's target is none of this body: other vertices, or elements that are turned over.
template <int dim>
void require_target(const Solid<dim>& body, const Vec& target, std::size_t pose);

struct MaterialWeights {
  double crisp = 0;      ///< k_mat of (5.17)
  double smooth = 0.2;   ///< k_smooth of (5.18)
  double soft = 1e-4;    ///< k_soft of (5.19)
  double length = 1e-3;  ///< the unit of distances in the objective [m]
  /// Weight of the largest squared distance beside the mean. Not smooth: for steps that only compare values.
  double largest = 0;
};

struct EquilibriumLimits {
  /// A layout whose equilibrium takes longer, or lies further from the last one, is refused: it has left the branch.
  int max_iterations = 25;
  double largest_displacement = 2e-3;  ///< of a vertex [m]
};

/// The reduced problem of section 5.5: densities rho (m) in [0, 1] such that the equilibria x^i(rho) of all poses
/// approach their targets,
///     f = mean_i mean_j |x^i_j - t^i_j|^2 / length^2 + k_mat mean rho (1 - rho) + k_smooth mean (rho_e - mean of its
///     neighbours)^2 + k_soft mean rho^2,
/// j over the vertices of the boundary (5.7), the other means over the elements: the weights do not depend on the mesh.
/// States are passed around explicitly: what a layout does depends on the state that it is approached from.
///
/// Free pins add their positions y^i to the design. They are few, and their part of the Gauss-Newton model is dense: it
/// is minimised exactly at every linearisation (variable projection; Golub and Pereyra 1973), so that gradient() and
/// distance_product() are those of the model that remains for rho, and predict() says how the pins follow.
template <int dim>
class MaterialDesign {
 public:
  /// A layout and the equilibrium of every pose.
  struct State {
    Vec rho;
    std::vector<Vec> x;
    std::vector<Vec> pins;  ///< (dim pins) a pose: where they are held [m]
    double distance = 0;    ///< mean of the squared distances [m^2]
    double largest = 0;     ///< largest squared distance [m^2]
  };

  /// How far the poses and their pins go, to first order; empty where that is not known.
  struct Step {
    std::vector<Vec> x, pins;
  };

  /// Throws InputError when a pose does not fit the body or its target turns elements over.
  MaterialDesign(const Solid<dim>& body, std::vector<MaterialPose<dim>> poses, EquilibriumLimits limits = {});

  const Solid<dim>& body() const { return body_; }
  const std::vector<MaterialPose<dim>>& poses() const { return poses_; }

  /// The equilibria at uniform or other first densities, from the poses' starts. Nothing when a pose has none.
  std::optional<State> start(const Vec& rho) const;
  /// The equilibria at new densities approached from `from`: the pins move by `step`, which predicts the poses as well.
  /// Nothing when one is not found within the limits.
  std::optional<State> move(const State& from, const Vec& rho, const Step& step = {}) const;
  /// The equilibria at new densities from `from` without these limits: another branch may be found.
  std::optional<State> restart(const State& from, const Vec& rho) const;
  /// How many times move() found nothing.
  int refused_moves() const { return refused_moves_; }
  /// Factorisations so far, of equilibria and of adjoints.
  int linear_solves() const;

  double objective(const State& state, const MaterialWeights& weights) const;

  /// Prepares the derivatives at a state: factorises the tangent of every pose. Returns false when one is not positive
  /// definite.
  bool linearize(const State& state, const MaterialWeights& weights);
  /// Sets the Levenberg-Marquardt damping of the free pins, relative to the mean diagonal of their Hessian.
  void damp_pins(double damping);
  /// df/drho at the linearised state, by one adjoint solve a pose.
  void gradient(Vec& g) const;
  /// df/dy of a pose's free pins [1/m].
  const Vec& pin_gradient(std::size_t pose) const { return projections_[pose].gradient; }
  /// By how much the pins alone lower the model.
  double pin_decrease() const;
  /// The Gauss-Newton Hessian of the distances times v, by two solves a pose.
  void distance_product(ConstVec v, Vec& Hv) const;
  /// The Hessian of the convex regularisers (m, m). The crispness is concave and has none.
  const SparseMatrix& regulariser_hessian(const MaterialWeights& weights) const;
  /// The displacements dx^i = Y dy^i - K^-1 B drho of every pose, and those of its free pins.
  Step predict(ConstVec drho) const;
  bool has_free_pins() const;

 private:
  /// The free pins of a pose in the linearised model.
  struct PinProjection {
    Eigen::MatrixXd sensitivity;  // Y = dx/dy (dim n, dim pins)
    Eigen::MatrixXd hessian;      // 2 Y^t W Y [1/m^2]
    Vec gradient;                 // 2 Y^t W (x - t) [1/m]
    Eigen::MatrixXd inverse;      // of the damped Hessian
  };

  LoadedSolid<dim> potential(std::size_t pose, const State& state) const;
  std::optional<Vec> equilibrium(std::size_t pose, const State& state, const Vec& from, const Vec& guess,
                                 const NewtonOptions& options) const;
  void linearize_pins(std::size_t pose);
  Vec past_pins(std::size_t pose, Vec force) const;
  Vec squared_distances(std::size_t pose, const Vec& x) const;
  void measure(State& state) const;
  Vec distance_weights(std::size_t pose, const State& state, const MaterialWeights& weights) const;

  const Solid<dim>& body_;
  std::vector<MaterialPose<dim>> poses_;
  EquilibriumLimits limits_;
  std::vector<int> boundary_;  // vertices
  SparseMatrix smoothing_;     // rho_e - mean of its neighbours
  SparseMatrix smoothing_hessian_;
  mutable SparseMatrix regulariser_;
  mutable SparseFactorization newton_factorization_;
  mutable int refused_moves_ = 0;

  // Of the linearised state.
  std::vector<SparseFactorization> tangents_;
  std::vector<SparseMatrix> mixed_;    // rows of held coordinates are zero
  std::vector<Vec> distance_weights_;  // W, (dim n) a pose [1/m^2]
  std::vector<Vec> distance_forces_;   // 2 W (x - t) [1/m]
  std::vector<PinProjection> projections_;
  Vec regulariser_gradient_;
};

}  // namespace softform
