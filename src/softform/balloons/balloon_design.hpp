#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "softform/balloons/nozzle.hpp"
#include "softform/core/report.hpp"
#include "softform/equilibrium/volume_control.hpp"
#include "softform/inverse/rest_shape_design.hpp"
#include "softform/materials/material.hpp"
#include "softform/mesh/distance.hpp"
#include "softform/mesh/triangle_mesh.hpp"
#include "softform/optimizers/optimizer.hpp"

namespace softform {

/// The weight of the aligned vertex-distance term that makes it count about as much as (4.12).
inline constexpr double vertex_distance_reference_weight = 10;

/// Where an optimisation starts.
struct BalloonStart {
  Positions rest;      ///< (n, 3) [m]
  Positions inflated;  ///< (n, 3) [m], near its equilibrium
};

/// How a balloon is designed. The weights are dimensionless; see docs of each objective for what they multiply.
struct BalloonOptions {
  double thickness = 3e-4;  ///< uniform [m]
  /// Size of the first rest shape, the downscaled target, relative to the target: stretches are near its inverse.
  double rest_scale = 0.5;
  /// Where the balloon is blown up: these vertices stay where the target has them, at rest and inflated. None: the
  /// balloon is closed and floats freely.
  std::optional<NozzlePlacement> nozzle;

  double stretch_weight = 1;          ///< k_l of (4.12)
  double bending_weight = 0.03;       ///< k_b of (4.12); larger ones ask for creases that no balloon can have
  double vertex_distance_weight = 0;  ///< aligned vertex distances: off as in the thesis
  double rest_bending_weight = 3e-3;  ///< bending of the rest shape away from the first one (thesis 4.4.2)
  double rest_volume_weight = 1e-4;   ///< prefers convex rest shapes
  double collision_weight = 10;       ///< of (4.15); steps to rest shapes that cut themselves are refused besides
  /// Threshold eps_c of (4.15) and the geodesic distance under which vertices are neighbours, in mean edge lengths of
  /// the first rest shape.
  /// They are close to each other so that the surface cannot fold over itself locally either: with 0.8 and 3 the bunny
  /// ended with 21 pairs of triangles that cut each other, all between neighbours of neighbours.
  double collision_threshold = 1.2;
  double collision_geodesic = 1.6;

  /// In place of the downscaled target, which still defines the problem: its pressure, and what (4.15) and the bending
  /// of the rest shape refer to. Shapes as optimised, before they are sized.
  std::optional<BalloonStart> start;

  StopCriteria stop{.max_iterations = 100, .max_time_s = 3600, .relative_decrease = 2e-2, .patience = 3};
  InflationOptions inflation;
};

/// What happened and when, for progress: the phase in words and, while optimising, the iterate.
struct BalloonProgress {
  const char* phase;
  const Iterate* iterate;  ///< nullptr outside the optimisation
};
using BalloonObserver = std::function<bool(const BalloonProgress&)>;

/// Seconds spent in each phase.
struct BalloonTimes {
  double inflation = 0;      ///< of the downscaled target
  double assembly = 0;       ///< derivatives and matrices of the shape steps
  double factorization = 0;  ///< of these matrices
  double solve = 0;          ///< with them
  double equilibrium = 0;    ///< solving for the equilibria of new rest shapes
  double collision = 0;      ///< looking for self-intersections of the rest shape
  double total = 0;

  double rest() const { return total - inflation - assembly - factorization - solve - equilibrium - collision; }
};

/// How often what was done.
struct BalloonCounts {
  int inflation_steps = 0;    ///< Newton iterations of the first inflation
  int shape_steps = 0;        ///< of the optimiser, accepted or not
  int equilibria = 0;         ///< solved for after shape steps
  int equilibrium_steps = 0;  ///< Newton iterations of these
};

/// A designed balloon. All shapes share the target's triangles. `inflated` and `downscaled` are aligned to the target,
/// unless a nozzle holds them where they are.
struct BalloonDesign {
  TriangleMesh rest;        ///< the shape to fabricate
  TriangleMesh inflated;    ///< its equilibrium
  TriangleMesh downscaled;  ///< the downscaled target inflated to the target's volume
  std::optional<Nozzle> nozzle;
  double pressure = 0;      ///< of `rest` and `inflated` [Pa]
  double size_factor = 1;   ///< s of step 3; (4.12) alone ends with `rest` and `inflated` divided by it (no nozzle)
  double mean_stretch = 0;  ///< (4.8)
  double residual = 0;      ///< largest nodal force, relative to a fully unbalanced vertex
  int negative_eigenvalues = -1;
  Report report;  ///< of the optimisation
  BalloonCounts counts;
  BalloonTimes times;
};

/// Designs the rest shape of a rubber balloon that inflates to `target` (closed, metres), chapter 4:
///   1. the target is scaled down by rest_scale and inflated to the target's volume, which gives the pressure;
///   2. the rest shape is optimised at that pressure from the downscaled one;
///   3. it is sized: (4.12) compares lengths, which a bulged surface keeps while its volume grows (a cube's by a
///      quarter), so that the design is scaled by s to enclose the target's volume. This needs no further solve: at one
///      thickness, a balloon scaled by s is in equilibrium at p/s, whatever its material. A nozzle keeps its size, so
///      that only what is away from it is scaled, and the equilibrium at the target's volume is solved for;
///   4. the equilibrium is checked.
/// When interrupted, the best rest shape so far is returned, feasible, with Termination::Interrupted.
/// Throws InputError when an option is out of its range or the nozzle does not fit. A first inflation that fails is
/// reported as Termination::Infeasible with the shapes reached.
BalloonDesign design_balloon(const TriangleMesh& target, std::shared_ptr<const Material> material,
                             const BalloonOptions& options = {}, const BalloonObserver& observer = {});

/// The thesis' distance (4.6) of aligned positions to the target, that of the vertices to its closest points; `each`
/// (n) receives the distance of every vertex.
ShapeDistance shape_distance(const TriangleMesh& inflated, const TriangleMesh& target, Vec* each = nullptr);

/// x moved rigidly to lie as close to the target's surface as it can; vertices correspond.
TriangleMesh aligned_to(const TriangleMesh& target, ConstVec x);

}  // namespace softform
