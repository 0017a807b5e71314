#include "softform/characters/pin_placement_program.hpp"

#include <cmath>

#include "softform/mesh/planar_mesh.hpp"

namespace softform {
namespace {

constexpr double mm = 1e-3;  // [m]

}  // namespace

PinPlacementProgram::PinPlacementProgram(const PlanarSolid& body, Vec densities, std::vector<Vec> targets,
                                         const Pins& start, std::vector<Vec> start_positions,
                                         const PinPlacementWeights& weights, FixedDofs held)
    : body_(body),
      places_(BoundaryField(body), start.places, start.sides, {weights.boundary, weights.repulsion}),
      densities_(std::move(densities)),
      targets_(std::move(targets)),
      start_positions_(std::move(start_positions)),
      start_(start),
      weights_(weights),
      held_(std::move(held))
{}

Vec PinPlacementProgram::initial_point() const
{
  Vec z(variable_count());
  for (int i = 0; i < pose_count(); ++i) {
    const auto pose = static_cast<std::size_t>(i);
    z.segment(Eigen::Index(i) * state_size(), state_size()) = start_positions_[pose] / mm;
    for (int j = 0; j < start_.count(); ++j)
      z.segment<2>(pin_start(i) + 2 * j) = start_.positions[pose][static_cast<std::size_t>(j)] / mm;
  }
  z.tail(pin_size()) = places_.start();
  return z;
}

Vec PinPlacementProgram::positions(ConstVec z, int pose) const
{
  return mm * z.segment(Eigen::Index(pose) * state_size(), state_size());
}

Point<2> PinPlacementProgram::place(ConstVec z, int pin) const
{
  return mm * z.segment<2>(pin_start(pose_count()) + 2 * pin);
}

Point<2> PinPlacementProgram::held_at(ConstVec z, int pose, int pin) const
{
  return mm * z.segment<2>(pin_start(pose) + 2 * pin);
}

Pins PinPlacementProgram::pins(ConstVec z) const
{
  Pins pins = start_;
  for (int j = 0; j < pins.count(); ++j) {
    pins.places[static_cast<std::size_t>(j)] = place(z, j);
    for (int i = 0; i < pose_count(); ++i)
      pins.positions[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] = held_at(z, i, j);
  }
  return pins;
}

double PinPlacementProgram::objective(ConstVec z) const
{
  double sum = places_.value(z.tail(pin_size()));
  for (int i = 0; i < pose_count(); ++i)
    sum += (positions(z, i) - targets_[static_cast<std::size_t>(i)]).squaredNorm() / (2 * mm * mm);
  return sum;
}

void PinPlacementProgram::objective_gradient(ConstVec z, Vec& g) const
{
  g = Vec::Zero(variable_count());
  for (int i = 0; i < pose_count(); ++i)
    g.segment(Eigen::Index(i) * state_size(), state_size()) =
        (positions(z, i) - targets_[static_cast<std::size_t>(i)]) / mm;
  Vec by_place;
  places_.gradient(z.tail(pin_size()), by_place);
  g.tail(pin_size()) = by_place;
}

void PinPlacementProgram::gauss_newton_hessian(ConstVec z, SparseMatrix& H) const
{
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < constraint_count(); ++i) entries.emplace_back(i, i, 1);
  places_.append_hessian(z.tail(pin_size()), static_cast<int>(pin_start(pose_count())), entries);
  H.resize(variable_count(), variable_count());
  H.setFromTriplets(entries.begin(), entries.end());
}

void PinPlacementProgram::constraints(ConstVec z, Vec& c) const
{
  c.resize(constraint_count());
  Vec g;
  for (int i = 0; i < pose_count(); ++i) {
    const Vec x = positions(z, i);
    body_.gradient(x, densities_, g);
    for (int j = 0; j < start_.count(); ++j) {
      const std::vector<BoundaryWeight> weights = places_.spread(z.tail(pin_size()), j);
      const Point<2> pull = weights_.stiffness * (weighted_mean(weights, x) - held_at(z, i, j));
      for (const BoundaryWeight& w : weights) g.segment<2>(2 * w.vertex) += w.value * pull;
    }
    for (Eigen::Index k = 0; k < g.size(); ++k)
      if (is_held(k)) g[k] = weights_.stiffness * (x[k] - body_.rest_positions()[k]);
    c.segment(Eigen::Index(i) * state_size(), state_size()) = g;
  }
}

void PinPlacementProgram::constraint_jacobian(ConstVec z, SparseMatrix& J) const
{
  const double k = weights_.stiffness;
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < pose_count(); ++i) {
    const Vec x = positions(z, i);
    const int at = i * state_size();
    body_.hessian(x, densities_, Projection::None, K_);
    for (int col = 0; col < K_.outerSize(); ++col)
      for (SparseMatrix::InnerIterator entry(K_, col); entry; ++entry)
        entries.emplace_back(at + static_cast<int>(entry.row()), at + col, mm * entry.value());
    for (int j = 0; j < start_.count(); ++j) {
      const std::vector<BoundaryWeight> weights = places_.spread(z.tail(pin_size()), j);
      const Point<2> stretch = weighted_mean(weights, x) - held_at(z, i, j);
      const Eigen::Matrix2d moved = weighted_gradient(weights, x);
      const int held = static_cast<int>(pin_start(i)) + 2 * j,
                placed = static_cast<int>(pin_start(pose_count())) + 2 * j;
      for (const BoundaryWeight& w : weights) {
        const int row = at + 2 * w.vertex;
        for (const BoundaryWeight& v : weights)
          for (int p = 0; p < 2; ++p) entries.emplace_back(row + p, at + 2 * v.vertex + p, mm * k * w.value * v.value);
        const Eigen::Matrix2d by_place = k * (w.value * moved + stretch * w.gradient.transpose());
        for (int p = 0; p < 2; ++p) {
          entries.emplace_back(row + p, held + p, -mm * k * w.value);
          for (int q = 0; q < 2; ++q) entries.emplace_back(row + p, placed + q, mm * by_place(p, q));
        }
      }
    }
  }
  std::erase_if(entries, [this](const auto& entry) { return is_held(entry.row() % state_size()); });
  for (int row = 0; row < constraint_count(); ++row)
    if (is_held(row % state_size())) entries.emplace_back(row, row, mm * k);
  J.resize(constraint_count(), variable_count());
  J.setFromTriplets(entries.begin(), entries.end());
}

LoadedSolid<2> PinPlacementProgram::loaded(ConstVec z, int pose) const
{
  std::vector<Pin<2>> pins;
  for (int j = 0; j < start_.count(); ++j)
    pins.push_back({spread_point(places_.spread(z.tail(pin_size()), j)), held_at(z, pose, j), weights_.stiffness});
  return LoadedSolid<2>(body_, densities_, {}, std::move(pins));
}

std::optional<Vec> PinPlacementProgram::restore(ConstVec z) const
{
  if (!places_.are_within_reach(z.tail(pin_size()))) return std::nullopt;
  NewtonOptions newton;
  newton.max_iterations = 40;
  Vec result = z;
  for (int i = 0; i < pose_count(); ++i) {
    const LoadedSolid<2> potential = loaded(z, i);
    // A predicted state may turn triangles over: then the last pose that was admissible is the one to start from.
    Vec x = positions(z, i);
    if (!std::isfinite(potential.value(x))) x = start_positions_[static_cast<std::size_t>(i)];
    for (Eigen::Index k = 0; k < x.size(); ++k)
      if (is_held(k)) x[k] = body_.rest_positions()[k];
    const Equilibrium equilibrium = solve_equilibrium(potential, x, factorization_, newton, held_);
    if (!equilibrium.report.converged()) {
      ++failed_equilibria_;
      return std::nullopt;
    }
    result.segment(Eigen::Index(i) * state_size(), state_size()) = equilibrium.x / mm;
  }
  return result;
}

}  // namespace softform
