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
};

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
template <int dim>
class MaterialDesign {
 public:
  /// A layout and the equilibrium of every pose.
  struct State {
    Vec rho;
    std::vector<Vec> x;
    double distance = 0;  ///< mean of the squared distances [m^2]
    double largest = 0;   ///< largest squared distance [m^2]
  };

  /// Throws InputError when a pose does not fit the body or its target turns elements over.
  MaterialDesign(const Solid<dim>& body, std::vector<MaterialPose<dim>> poses, EquilibriumLimits limits = {});

  const Solid<dim>& body() const { return body_; }
  const std::vector<MaterialPose<dim>>& poses() const { return poses_; }

  /// The equilibria at uniform or other first densities, from the poses' starts. Nothing when a pose has none.
  std::optional<State> start(const Vec& rho) const;
  /// The equilibria at new densities approached from `from`, where the poses' displacements are predicted by `guess`
  /// (or empty). Nothing when one is not found within the limits.
  std::optional<State> move(const State& from, const Vec& rho, const std::vector<Vec>& guess = {}) const;
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
  /// df/drho at the linearised state, by one adjoint solve a pose.
  void gradient(Vec& g) const;
  /// The Gauss-Newton Hessian of the distances times v, by two solves a pose.
  void distance_product(ConstVec v, Vec& Hv) const;
  /// The Hessian of the convex regularisers (m, m). The crispness is concave and has none.
  const SparseMatrix& regulariser_hessian(const MaterialWeights& weights) const;
  /// The displacements dx^i = -K^-1 B drho of every pose.
  std::vector<Vec> predict(ConstVec drho) const;

 private:
  LoadedSolid<dim> potential(const MaterialPose<dim>& pose, const Vec& rho) const;
  std::optional<Vec> equilibrium(std::size_t pose, const Vec& rho, const Vec& from, const Vec& guess,
                                 const NewtonOptions& options) const;
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
  std::vector<Vec> distance_weights_;  // (dim n) a pose [1/m^2]
  Vec gradient_;
};

}  // namespace softform
