#pragma once

#include <vector>

#include "softform/mesh/triangle_mesh.hpp"

namespace softform {

/// When a design that is under way first looked like its outcome. Meshes may change from one shape to the next.
class PreviewTime {
 public:
  /// The shape at a time [s]; times grow.
  void record(double time, TriangleMesh shape);

  /// The time from which on all shapes are within `distance` [m] of the last one, on samples of them; NaN without any.
  double within(double distance) const;

 private:
  std::vector<double> times_;
  std::vector<TriangleMesh> shapes_;
};

}  // namespace softform
