#pragma once

#include <functional>
#include <memory>
#include <string>

#include "softform/inflatables/panel_remeshing.hpp"
#include "softform/inflatables/pattern_design.hpp"
#include "softform/optimizers/feasible_newton.hpp"

namespace softform {

/// The shape that an inflatable should take.
class PatternTarget {
 public:
  /// A closed surface [m].
  explicit PatternTarget(TriangleMesh surface);

  const TriangleMesh& surface() const { return surface_; }
  /// The longest side of the bounding box [m]: the unit of lengths in the objectives.
  double size() const { return size_; }
  /// Of the surface in units of its size.
  const std::shared_ptr<const ImlsField>& field() const { return field_; }
  const SurfaceDistance& distance() const { return *distance_; }

 private:
  TriangleMesh surface_;
  double size_;
  std::shared_ptr<const ImlsField> field_;
  std::shared_ptr<const SurfaceDistance> distance_;
};

/// Panels with the shape that they take when inflated.
struct InflatedPanels {
  PanelLayout layout;  ///< flat panels, and where their nodes belong on the target [m]
  Vec x;               ///< (3n) inflated positions of the nodes [m]
};

struct PatternOptions {
  PatternWeights weights;
  InteriorLaplacian laplacian = InteriorLaplacian::MeanValue;
  PanelRemeshingOptions remeshing;
  int max_remeshings = 30;
  /// Triangles that grow by more than this factor in area are meshed anew too: what is large sees little of the target.
  double largest_growth = 4;
  /// A method of the registry (all but the default one, whose iterates are stable, without the stability barrier), and
  /// the settings of the default one, whose damping is carried through remeshings.
  std::string optimizer = "feasible_newton";
  FeasibleNewtonOptions newton;
  /// The thesis' criterion: the largest entry of the Lagrangian's gradient, lengths in units of the target's size; or
  /// an objective that falls no more, as where a design is about to lose its stability. Forces are balanced to
  /// InflationSettings::newton at every iterate.
  StopCriteria stop{.max_iterations = 500, .relative_decrease = 2e-5, .patience = 20, .tolerance = 1e-3};
  /// The gradient, in units of that tolerance, at which InflationSettings::first_material has done its part.
  double first_tolerance = 10;
};

/// An iterate, as shown to an observer. Every one is a design that could be made, with its inflated shape: that of
/// InflationSettings::first_material as long as it is used.
struct PatternProgress {
  const InflatedPanels& panels;
  const Iterate& iterate;  ///< numbered and timed through all remeshings
  int remeshings;
};
/// Returning false ends the optimisation with what it has.
using PatternObserver = std::function<bool(const PatternProgress&)>;

struct PatternOptimum {
  InflatedPanels panels;
  double residual = 0;  ///< largest unbalanced force on a node, relative to the pressure on one
  int remeshings = 0;
  Report report;  ///< its trace goes through all remeshings; empty where the start has no equilibrium
};

/// What the panels inflate into from the shape that they have, under other settings say.
Equilibrium inflate_again(const InflatedPanels& panels, const InflationSettings& inflation);

/// Inflates the panels as they are, from the places of their nodes on the target.
InflatedPanels inflated_panels(PanelLayout layout, const InflationSettings& inflation);

/// Finds the flat panels that inflate to the target (6.16), from panels near equilibrium: triangles that get worse than
/// the threshold end a round, all panels are meshed anew, and the optimisation goes on from the state at hand. The same
/// call goes on from the last result after a seam was edited. Throws InputError for an unknown optimiser.
PatternOptimum optimize_pattern(const InflatedPanels& start, const PatternTarget& target,
                                const InflationSettings& inflation, const PatternOptions& options = {},
                                const PatternObserver& observer = {});

}  // namespace softform
