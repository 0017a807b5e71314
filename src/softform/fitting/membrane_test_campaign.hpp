#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "softform/core/types.hpp"
#include "softform/materials/material.hpp"
#include "softform/mesh/rbf_implicit.hpp"

namespace softform {

/// One loading step of a sample, as measured.
struct LoadingStep {
  double volume = 0;    ///< of the air under the sheet [m^3]
  double pressure = 0;  ///< [Pa]
  Positions scan;       ///< points on the sheet (m, 3) [m]
};

/// A sample in the clamp and what was measured of it.
struct MembraneSample {
  double nominal_thickness = 0;  ///< [m]
  double thickness = 0;          ///< as measured, with the gauge's error [m]
  std::vector<LoadingStep> steps;
};

/// The measuring campaign of 4.3.2, and how imperfect its instruments are.
struct CampaignOptions {
  double radius = 0.03;  ///< of the clamp's opening [m]
  std::vector<double> thicknesses{0.25e-3, 0.5e-3, 0.75e-3, 1e-3};
  int samples = 3;              ///< of each thickness
  std::vector<double> volumes;  ///< of the loading steps, rising [m^3]

  double thickness_tolerance = 0.05;  ///< of fabrication: samples are uniform within plus or minus this fraction
  double thickness_error = 0.005;     ///< standard error of the gauge, relative
  double volume_error = 0.001;        ///< standard error of the injected volume, relative
  double pressure_error = 10;         ///< standard error of the manometer [Pa]
  double scan_error = 5e-5;           ///< standard error of a scanned point in each direction [m]
  int scan_points = 3000;             ///< before points are lost
  double hidden_height = 1.5e-3;      ///< the ring of the clamp hides what lies lower [m]
  double steepest_undercut = 0.3;     ///< the scanner sees no normal that points down by more than this
  double hole_radius = 5e-3;          ///< two round holes in every scan [m]
  double lost_share = 0.05;           ///< points lost at random

  int rings = 30;  ///< of the mesh that stands for reality; finer than any mesh to be fitted
  std::uint64_t seed = 1;
};

/// Volumes of `count` equal steps up to `largest`.
std::vector<double> equal_volume_steps(double largest, int count);

/// The edge of the clamp's opening as points (60, 3) [m]: a scanned sheet is known to end there.
Positions rim(double radius);

/// Simulates the campaign on sheets of a known material, thickness by thickness and sample by sample. In a sheet of
/// uniform thickness the shape at a volume does not depend on the thickness, and the pressure is proportional to it.
/// Throws InputError when the options make no sense or a volume cannot be reached.
std::vector<MembraneSample> simulate_campaign(const std::shared_ptr<const Material>& material,
                                              const CampaignOptions& options);

/// What is read from a scanned sheet.
struct ScannedSheet {
  double extension = 0;  ///< averaged extension ratio (4.8): the root of the ratio of the sheet's area to the opening's
  double volume = 0;     ///< between the sheet and the plane of the clamp [m^3]
};

/// Measures a scanned sheet of about this volume: a sphere's cap on the clamp is projected onto the implicit surface.
ScannedSheet measure_scan(const RbfImplicit& surface, double radius, double volume);

}  // namespace softform
