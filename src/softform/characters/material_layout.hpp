#pragma once

#include <functional>
#include <string>
#include <vector>

#include "softform/inverse/material_design.hpp"

namespace softform {

struct MaterialLayoutOptions {
  /// k_smooth and k_soft, and k_mat at the first stage.
  MaterialWeights weights{4e-3, 0.2, 1e-4, 1e-3, 0};
  /// Growth of k_mat from stage to stage: faster growth freezes the layout before it has found its shape.
  double crispness_growth = 1.5;
  int max_stages = 40;
  /// Steps of a stage, and the relative decrease under which a stage is over.
  int steps_per_stage = 6;
  double stage_decrease = 1e-2;
  /// Levenberg-Marquardt damping at the start of every stage, in units of the mean Hessian of the smoothness; its
  /// factor after a refused step, and when a stage gives up.
  double damping = 1;
  double damping_growth = 4;
  double largest_damping = 1e6;
  /// Damping of free pins where that of the densities is at its start, relative to their mean Hessian; both grow
  /// together. Where pins follow alone: how many steps they take at most.
  double pin_damping = 1e-3;
  int pin_steps = 5;
  /// Conjugate gradients need not be exact: what they leave, the next step sees again.
  int cg_iterations = 20;
  double cg_tolerance = 0.1;
  /// An element counts as grey while rho (1 - rho) exceeds this.
  double grey = 1e-3;
  /// The continuation ends when no larger fraction of the elements is grey: pushing k_mat until the last one yields
  /// ruins the design. The rest is decided by true equilibria.
  double grey_fraction = 2e-3;
  /// How often a decision is halved whose equilibrium is refused.
  int largest_halvings = 4;
  /// Elements flipped after that at most, alone or in pairs, and how many of the most promising ones are tried for
  /// each.
  int largest_flips = 60;
  int flip_candidates = 40;
  /// Weight of the largest squared distance, once no flip lowers the mean any more.
  double largest_weight = 0.2;
};

/// A step of the optimisation, as shown to an observer and kept as a trace.
struct LayoutProgress {
  std::string phase;  ///< "continuation", "decision" or "flips"
  int stage = 0, step = 0;
  double objective = 0;
  double distance = 0;  ///< root of the mean squared distance over all poses [m]
  int grey_elements = 0;
  int refused_moves = 0;
};
/// The progress in words, for a person who waits.
std::string describe(const LayoutProgress& progress);
/// Returning false ends the optimisation with what it has.
using LayoutObserver = std::function<bool(const LayoutProgress&)>;

template <int dim>
struct MaterialLayout {
  typename MaterialDesign<dim>::State state;  ///< every density is 0 or 1
  /// The distances before k_mat grew, after the continuation (grey elements left), and as soon as all were decided [m].
  double first_distance = 0, continued_distance = 0, decided_distance = 0;
  int flips = 0;
  int refused_moves = 0;  ///< layouts whose equilibrium was not found within the limits
  std::vector<LayoutProgress> trace;
  Report report;
};

/// The material layout of section 5.5 from a first state: Gauss-Newton steps with conjugate gradients within the bounds
/// at growing k_mat, then decisions and flips by true equilibria. A layout whose equilibrium fails is refused and
/// counted, so that every step is an equilibrium. Termination is Converged only when every density is 0 or 1.
template <int dim>
MaterialLayout<dim> optimize_layout(MaterialDesign<dim>& design, const typename MaterialDesign<dim>::State& first,
                                    const MaterialLayoutOptions& options = {}, const LayoutObserver& observer = {});

}  // namespace softform
