#include "softform/characters/string_candidates.hpp"

#include <algorithm>
#include <numbers>

#include "softform/characters/sliding_places.hpp"
#include "softform/mesh/planar_mesh.hpp"

namespace softform {

Point<2> StringCandidates::direction(int j, ConstVec x) const
{
  return (ring.at(angle_of(j)) - weighted_mean(site_of(j).weights, x)).normalized();
}

StringLayout StringCandidates::layout(const std::vector<int>& chosen, std::vector<Vec> tensions) const
{
  StringLayout layout{ring, {}, {}, {}, std::move(tensions)};
  for (const int j : chosen) {
    layout.places.push_back(site_of(j).place);
    layout.sides.push_back(site_of(j).side);
    layout.angles.push_back(angle_of(j));
  }
  return layout;
}

StringCandidates string_candidates(const PosedBody& posed, const Ring& ring, const StringCandidateOptions& options)
{
  const auto& [body, densities, held, targets] = posed;
  const BoundaryField field(body);
  const auto edges = boundary_faces<2>(body.elements()).faces;
  const Vec& X = body.rest_positions();
  StringCandidates all{ring, {}, {}};
  for (const int vertex : boundary_vertices<2>(body.elements())) {
    if (held.free.size() > 0 && held.free.segment<2>(2 * vertex).minCoeff() == 0) continue;
    StringCandidates::Site site{X.segment<2>(2 * vertex), field.normal(X.segment<2>(2 * vertex)), {}};
    site.weights = field.weights(site.place, field.kernels(site.place, site.side, field.radius()));
    const auto leaves = [&](const Vec& x, double angle) {
      return length_inside(edges, x, weighted_mean(site.weights, x), ring.at(angle)) < field.radius() / 4;
    };
    for (int k = 0; k < options.ring_points; ++k) {
      const double angle = 2 * std::numbers::pi * k / options.ring_points;
      const Point<2> way = ring.at(angle) - weighted_mean(site.weights, X);
      if (way.normalized().dot(site.side) > options.least_cosine && leaves(X, angle) &&
          std::all_of(targets.begin(), targets.end(), [&](const Vec& t) { return leaves(t, angle); }))
        all.lines.push_back({all.sites.size(), angle});
    }
    all.sites.push_back(std::move(site));
  }
  return all;
}

}  // namespace softform
