#pragma once

#include <functional>
#include <string>
#include <vector>

#include "softform/characters/pose_error.hpp"
#include "softform/characters/reachability.hpp"
#include "softform/core/report.hpp"

namespace softform {

/// What a stage of the pipeline of chapter 5 ended with, whatever the body is held by. Positions are true equilibria.
template <int dim>
struct CharacterStage {
  int number = 0;  ///< 1 the actuators' number, 2 their places, 3 two materials
  Vec densities;   ///< (m) of the elements: 0 soft, 1 stiff
  // A pose each:
  std::vector<Vec> positions;             ///< (dim n) [m]
  std::vector<PoseError> errors;          ///< over all vertices, those of table 5.1
  std::vector<double> residuals;          ///< largest unbalanced nodal force, relative to the force scale
  std::vector<int> negative_eigenvalues;  ///< of the tangent: 0 is stable
  std::vector<PoseTrace> traces;          ///< from rest to the pose; empty unless asked for

  Report report;              ///< how the stage ended; Converged says that what it had to do is done
  int failed_equilibria = 0;  ///< inside the stage; each refused a step
  int grey_elements = 0;      ///< further than 1e-3 from 0 and from 1
  double seconds = 0;         ///< of the stage, without the traces
  double trace_seconds = 0;

  /// Means over the poses [m].
  double mean_error() const;
  double mean_max_error() const;
  /// Every pose is balanced (to 1e-6) and stable.
  bool is_sound() const;
};

/// The loads of a body in a pose, at the densities of a stage.
template <int dim>
using PosePotential = std::function<LoadedSolid<dim>(std::size_t pose)>;

/// Fills in errors, residuals, negative eigenvalues and grey elements, for the poses that the stage has positions of.
template <int dim>
void measure_stage(CharacterStage<dim>& stage, const std::vector<Vec>& targets, const FixedDofs& fixed,
                   const PosePotential<dim>& potential);

/// What a pipeline is doing, for a person who waits.
struct PipelineProgress {
  int stage = 0;
  std::string text;
};
/// Returning false ends the pipeline with the stages that it has, the running one as far as it came.
using PipelineObserver = std::function<bool(const PipelineProgress&)>;

/// Tells an observer, and remembers that it wanted to stop.
class PipelineWatch {
 public:
  explicit PipelineWatch(const PipelineObserver& observer) : observer_(observer) {}
  /// Whether to go on.
  bool operator()(int stage, const std::string& text)
  {
    is_stopped_ = is_stopped_ || (observer_ && !observer_({stage, text}));
    return !is_stopped_;
  }
  bool is_stopped() const { return is_stopped_; }

 private:
  const PipelineObserver& observer_;
  bool is_stopped_ = false;
};

}  // namespace softform
