#pragma once

// What figures 6.10 and 6.12 and tables 6.1 and 6.2 share: the sphere and the teddy, cut along their seams, inflated
// and optimised, and what is measured of them. Everything has size 1 and pressure 1.

#include <string>

#include "softform/experiment/run.hpp"
#include "softform/inflatables/pattern_optimization.hpp"
#include "softform/inflatables/preview_time.hpp"

namespace softform::experiments {

/// One of the thesis' models as it is given: a target with its seams, cut, its panels not yet flat.
struct InflatableModel {
  std::string name;
  PatternTarget target;
  PanelLayout layout;
};

/// "sphere" (692 faces, 3 panels) or "teddy" (2974 faces, 17 panels): as many as in table 6.2, fewer at the quick size.
InflatableModel load_inflatable(const Run& run, const std::string& name);

/// Polyester film (datasets/materials/mylar.json) of 25 um at 1 kPa on a model of 40 cm, kappa h = 39.5 p x size, as it
/// is designed with.
InflationSettings design_film();

/// A design and how it came about.
struct InflatableDesign {
  InflatedPanels unoptimised;
  PatternOptimum optimum;
  PreviewTime preview;  ///< from the first inflated panels on
};

/// Optimises from panels that are inflated already, with its progress.
InflatableDesign design_inflatable(Run& run, const InflatableModel& model, InflatedPanels start,
                                   const PatternWeights& weights = {});
/// Flattens and inflates the model's panels first.
InflatableDesign design_inflatable(Run& run, const InflatableModel& model);

/// Writes metrics of a design with `suffix`: distances on samples of the surface in units of the size, also
/// under the relaxed energy itself, seams, quality, balance, iterations.
void report_design(Run& run, const InflatableModel& model, const InflatableDesign& design, const std::string& suffix);

/// Writes the inflated surface with its panels, and its distance to the target.
void write_inflated(const Run& run, const std::string& file, const InflatedPanels& panels, const PatternTarget& target);

/// Writes the flat panels, side by side.
void write_flat(const Run& run, const std::string& file, const PanelLayout& layout);

}  // namespace softform::experiments
