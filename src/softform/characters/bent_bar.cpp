#include "softform/characters/bent_bar.hpp"

#include <algorithm>
#include <cmath>

namespace softform {
namespace {

double smoothstep(double t)
{
  t = std::clamp(t, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

double curvature(const std::vector<Bend>& bends, double s)
{
  double sum = 0;
  for (const Bend& bend : bends)
    sum += bend.angle / (bend.end - bend.begin - bend_fade) * smoothstep((s - bend.begin) / bend_fade) *
           smoothstep((bend.end - s) / bend_fade);
  return sum;
}

// The centre line from its far end (at the origin, heading along x) back to s, by the midpoint rule.
struct CentreLine {
  CentreLine(const std::vector<Bend>& bends, double length, double fraction)
      : step(length / steps), points(steps + 1), angles(steps + 1)
  {
    points[steps].setZero();
    angles[steps] = 0;
    for (int k = steps; k-- > 0;) {
      const auto i = static_cast<std::size_t>(k);
      angles[i] = angles[i + 1] - fraction * step * curvature(bends, (k + 0.5) * step);
      const double middle = (angles[i] + angles[i + 1]) / 2;
      points[i] = points[i + 1] - step * Eigen::Vector2d(std::cos(middle), std::sin(middle));
    }
  }

  static constexpr int steps = 4000;
  double step;
  std::vector<Eigen::Vector2d> points;
  std::vector<double> angles;
};

}  // namespace

Vec bent_bar(const SimplexMesh<3>& bar, const std::vector<Bend>& bends, double fraction)
{
  const Positions X = unflatten(bar.positions);
  const double length = X.col(0).maxCoeff(), middle = X.col(1).maxCoeff() / 2;
  const CentreLine line(bends, length, fraction);
  Positions x = X;
  for (Eigen::Index i = 0; i < X.rows(); ++i) {
    const double place = std::clamp(X(i, 0) / line.step, 0.0, double(CentreLine::steps));
    const auto k = static_cast<std::size_t>(std::min(place, CentreLine::steps - 1.0));
    const double t = place - double(k);
    const double angle = (1 - t) * line.angles[k] + t * line.angles[k + 1];
    const Eigen::Vector2d centre = (1 - t) * line.points[k] + t * line.points[k + 1];
    const Eigen::Vector2d normal(-std::sin(angle), std::cos(angle));
    const Eigen::Vector2d at = Eigen::Vector2d(length, middle) + centre + (X(i, 1) - middle) * normal;
    x.row(i) << at.x(), at.y(), X(i, 2);
  }
  return flatten(x);
}

FixedDofs end_caps(const SimplexMesh<3>& bar, double length)
{
  const double end = unflatten(bar.positions).col(0).maxCoeff();
  FixedDofs caps{Vec::Ones(bar.positions.size())};
  for (int i = 0; i < bar.vertex_count(); ++i) {
    const double x = bar.positions[3 * i];
    if (x < length * (1 + 1e-9) || x > end - length * (1 + 1e-9)) caps.free.segment<3>(3 * i).setZero();
  }
  return caps;
}

}  // namespace softform
