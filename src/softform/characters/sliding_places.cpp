#include "softform/characters/sliding_places.hpp"

#include <limits>

namespace softform {
namespace {

constexpr double mm = 1e-3;  // [m]

// (5.13) acts on places nearer than this part of the kernels' radius: those spread over the same vertices.
constexpr double repulsion_reach = 1;

Point<2> place_of(ConstVec l, int j) { return mm * l.segment<2>(2 * Eigen::Index(j)); }

}  // namespace

SlidingPlaces::SlidingPlaces(const BoundaryField& field, const std::vector<Point<2>>& places,
                             const std::vector<Point<2>>& sides, const SlidingWeights& weights)
    : field_(field), start_(places), weights_(weights)
{
  for (std::size_t j = 0; j < places.size(); ++j)
    kernels_.push_back(field_.kernels(places[j], sides[j], 2 * field_.radius()));
}

Vec SlidingPlaces::start() const
{
  Vec l(2 * count());
  for (int j = 0; j < count(); ++j) l.segment<2>(2 * j) = start_[static_cast<std::size_t>(j)] / mm;
  return l;
}

std::vector<BoundaryWeight> SlidingPlaces::spread(ConstVec l, int j) const
{
  const auto index = static_cast<std::size_t>(j);
  std::vector<BoundaryWeight> weights = field_.weights(place_of(l, j), kernels_[index]);
  if ((place_of(l, j) - start_[index]).norm() > field_.radius())
    for (BoundaryWeight& w : weights) w.value = std::numeric_limits<double>::quiet_NaN();
  return weights;
}

bool SlidingPlaces::are_within_reach(ConstVec l) const
{
  for (int j = 0; j < count(); ++j)
    for (const BoundaryWeight& w : spread(l, j))
      if (!std::isfinite(w.value)) return false;
  return true;
}

double SlidingPlaces::field_value(ConstVec l, int j, Point<2>* gradient) const
{
  return field_.value(place_of(l, j), kernels_[static_cast<std::size_t>(j)], gradient) / mm;
}

// (5.13) and its gradient.
double SlidingPlaces::repulsion(ConstVec l, Vec* gradient) const
{
  const double reach = repulsion_reach * field_.radius() / mm;
  double sum = 0;
  for (int a = 0; a < count(); ++a)
    for (int b = 0; b < a; ++b) {
      const Point<2> apart = l.segment<2>(2 * a) - l.segment<2>(2 * b);
      const double depth = reach - apart.norm();
      if (!(depth > 0)) continue;
      sum += weights_.repulsion * depth * depth * depth;
      if (!gradient) continue;
      const Point<2> push = -3 * weights_.repulsion * depth * depth * apart.normalized();
      gradient->segment<2>(2 * a) += push;
      gradient->segment<2>(2 * b) -= push;
    }
  return sum;
}

double SlidingPlaces::value(ConstVec l) const
{
  double sum = repulsion(l, nullptr);
  for (int j = 0; j < count(); ++j) {
    const double phi = field_value(l, j, nullptr);
    sum += weights_.boundary / 2 * phi * phi;
  }
  return sum;
}

void SlidingPlaces::gradient(ConstVec l, Vec& g) const
{
  g.resize(2 * count());
  for (int j = 0; j < count(); ++j) {
    Point<2> slope;
    const double phi = field_value(l, j, &slope);
    g.segment<2>(2 * j) = weights_.boundary * phi * slope;
  }
  repulsion(l, &g);
}

void SlidingPlaces::append_hessian(ConstVec l, int first, std::vector<Eigen::Triplet<double>>& entries) const
{
  for (int j = 0; j < count(); ++j) {
    Point<2> slope;
    field_value(l, j, &slope);
    for (int p = 0; p < 2; ++p)
      for (int q = 0; q < 2; ++q)
        entries.emplace_back(first + 2 * j + p, first + 2 * j + q, weights_.boundary * slope[p] * slope[q]);
  }
}

void project_onto_boundary(const BoundaryField& field, std::vector<Point<2>>& places, std::vector<Point<2>>& sides)
{
  for (std::size_t j = 0; j < places.size(); ++j) {
    places[j] = field.projected(places[j], sides[j]);
    sides[j] = field.normal(places[j]);
  }
}

Point<2> weighted_mean(const std::vector<BoundaryWeight>& weights, ConstVec x)
{
  Point<2> sum = Point<2>::Zero();
  for (const BoundaryWeight& w : weights) sum += w.value * x.segment<2>(2 * w.vertex);
  return sum;
}

Eigen::Matrix2d weighted_gradient(const std::vector<BoundaryWeight>& weights, ConstVec x)
{
  Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
  for (const BoundaryWeight& w : weights) sum += x.segment<2>(2 * w.vertex) * w.gradient.transpose();
  return sum;
}

BodyPoint spread_point(const std::vector<BoundaryWeight>& weights)
{
  BodyPoint point;
  for (const BoundaryWeight& w : weights) {
    point.vertices.push_back(w.vertex);
    point.weights.push_back(w.value);
  }
  return point;
}

}  // namespace softform
