#include "softform/inflatables/preview_time.hpp"

#include <limits>
#include <utility>

#include "softform/mesh/distance.hpp"

namespace softform {

void PreviewTime::record(double time, TriangleMesh shape)
{
  times_.push_back(time);
  shapes_.push_back(std::move(shape));
}

double PreviewTime::within(double distance) const
{
  if (shapes_.empty()) return std::numeric_limits<double>::quiet_NaN();
  constexpr int samples = 5000;
  const SurfaceDistance last(shapes_.back());
  std::size_t first = shapes_.size() - 1;
  while (first > 0 && sampled_distance(shapes_[first - 1], last, samples).max <= distance) --first;
  return times_[first];
}

}  // namespace softform
