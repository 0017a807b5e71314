#include "softform/characters/boundary_field.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "softform/mesh/planar_mesh.hpp"

namespace softform {
namespace {

using Place = BoundaryField::Place;

// The right-hand normal of an edge, which points out of a body to the edge's left.
Place edge_normal(const Place& a, const Place& b) { return Place(b.y() - a.y(), a.x() - b.x()).normalized(); }

Place nearest_on(const std::array<Place, 2>& edge, const Place& place)
{
  const Place along = edge[1] - edge[0];
  return edge[0] + std::clamp((place - edge[0]).dot(along) / along.squaredNorm(), 0.0, 1.0) * along;
}

}  // namespace

BoundaryField::BoundaryField(const PlanarSolid& body, double radius_in_edges)
{
  const auto faces = boundary_faces<2>(body.elements()).faces;
  const auto points = rows_of(body.rest_positions());
  std::map<int, Place> normals;
  double length = 0;
  for (Eigen::Index f = 0; f < faces.rows(); ++f) {
    const Place a = points.row(faces(f, 0)).transpose(), b = points.row(faces(f, 1)).transpose();
    edges_.push_back({a, b});
    length += (b - a).norm();
    for (int k = 0; k < 2; ++k) normals.try_emplace(faces(f, k), Place::Zero()).first->second += edge_normal(a, b);
  }
  radius_ = radius_in_edges * length / static_cast<double>(faces.rows());
  for (const auto& [vertex, normal] : normals) {
    vertices_.push_back(vertex);
    points_.emplace_back(points.row(vertex).transpose());
    normals_.push_back(normal.normalized());
  }
}

std::vector<int> BoundaryField::kernels(const Place& place, const Place& side, double distance) const
{
  std::vector<int> result;
  for (std::size_t k = 0; k < points_.size(); ++k)
    if ((points_[k] - place).norm() < distance && normals_[k].dot(side) > 0) result.push_back(static_cast<int>(k));
  return result;
}

Place BoundaryField::normal(const Place& place) const
{
  const auto nearest = std::min_element(points_.begin(), points_.end(), [&](const Place& a, const Place& b) {
    return (a - place).squaredNorm() < (b - place).squaredNorm();
  });
  return normals_[static_cast<std::size_t>(nearest - points_.begin())];
}

Place BoundaryField::projected(const Place& place, const Place& side) const
{
  Place best = place;
  double least = std::numeric_limits<double>::infinity();
  for (const auto& edge : edges_) {
    if (edge_normal(edge[0], edge[1]).dot(side) <= 0) continue;
    const Place candidate = nearest_on(edge, place);
    if ((candidate - place).norm() >= least) continue;
    least = (candidate - place).norm();
    best = candidate;
  }
  return best;
}

std::vector<BoundaryWeight> BoundaryField::weights(const Place& place, const std::vector<int>& kernels) const
{
  std::vector<BoundaryWeight> result;
  double sum = 0;
  Place sum_gradient = Place::Zero();
  for (const int k : kernels) {
    const Place d = place - points_[static_cast<std::size_t>(k)];
    const double t = std::max(0.0, 1 - d.squaredNorm() / (radius_ * radius_));
    const double phi = t * t * t * t;
    const Place gradient = -8 * t * t * t / (radius_ * radius_) * d;
    result.push_back({vertices_[static_cast<std::size_t>(k)], phi, gradient});
    sum += phi;
    sum_gradient += gradient;
  }
  for (BoundaryWeight& weight : result) {
    weight.value /= sum;  // 0/0 = NaN where no kernel reaches
    weight.gradient = (weight.gradient - weight.value * sum_gradient) / sum;
  }
  return result;
}

double BoundaryField::value(const Place& place, const std::vector<int>& kernels, Place* gradient) const
{
  const std::vector<BoundaryWeight> normalized = weights(place, kernels);
  double phi = 0;
  if (gradient) gradient->setZero();
  for (std::size_t i = 0; i < kernels.size(); ++i) {
    const auto k = static_cast<std::size_t>(kernels[i]);
    const double height = normals_[k].dot(place - points_[k]);
    phi += normalized[i].value * height;
    if (gradient) *gradient += normalized[i].value * normals_[k] + height * normalized[i].gradient;
  }
  return kernels.empty() ? std::numeric_limits<double>::quiet_NaN() : phi;
}

}  // namespace softform
