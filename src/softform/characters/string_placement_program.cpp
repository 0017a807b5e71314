#include "softform/characters/string_placement_program.hpp"

#include <cmath>
#include <limits>

namespace softform {
namespace {

constexpr double mm = 1e-3;  // [m]

}  // namespace

StringPlacementProgram::StringPlacementProgram(const PosedBody& posed, const StringLayout& start,
                                               std::vector<Vec> start_positions, const StringPlacementWeights& weights)
    : posed_(posed),
      field_(posed.body),
      normals_(posed.body),
      sliding_(field_, start.places, start.sides, weights.sliding),
      start_positions_(std::move(start_positions)),
      start_(start),
      weights_(weights)
{}

Vec StringPlacementProgram::initial_point() const
{
  Vec z(variable_count());
  for (int i = 0; i < pose_count(); ++i) {
    const auto pose = static_cast<std::size_t>(i);
    z.segment(Eigen::Index(i) * state_size(), state_size()) = start_positions_[pose] / mm;
    z.segment(tension_start(i), string_count()) = start_.tensions[pose];
  }
  for (int j = 0; j < string_count(); ++j)
    z[arc_start() + j] = start_.ring.radius * start_.angles[static_cast<std::size_t>(j)] / mm;
  z.tail(2 * string_count()) = sliding_.start();
  return z;
}

Vec StringPlacementProgram::lower_bounds() const
{
  Vec lower = Vec::Constant(variable_count(), -std::numeric_limits<double>::infinity());
  lower.segment(tension_start(0), Eigen::Index(pose_count()) * string_count()).setZero();
  return lower;
}

Vec StringPlacementProgram::positions(ConstVec z, int pose) const
{
  return mm * z.segment(Eigen::Index(pose) * state_size(), state_size());
}

StringLayout StringPlacementProgram::layout(ConstVec z) const
{
  StringLayout layout = start_;
  for (int j = 0; j < string_count(); ++j) {
    const auto index = static_cast<std::size_t>(j);
    layout.places[index] = mm * places(z).segment<2>(2 * Eigen::Index(j));
    layout.angles[index] = mm * z[arc_start() + j] / start_.ring.radius;
  }
  for (int i = 0; i < pose_count(); ++i)
    layout.tensions[static_cast<std::size_t>(i)] = z.segment(tension_start(i), string_count());
  return layout;
}

StringPlacementProgram::Line StringPlacementProgram::line(ConstVec z, ConstVec x, int pose, int string) const
{
  Line line;
  line.weights = sliding_.spread(places(z), string);
  line.tension = z[tension_start(pose) + string];
  const double angle = mm * z[arc_start() + string] / start_.ring.radius;
  const Point<2> way = start_.ring.at(angle) - weighted_mean(line.weights, x);
  line.length = way.norm();
  line.direction = way / line.length;
  line.along_ring = Point<2>(-std::sin(angle), std::cos(angle));
  line.turning = (Eigen::Matrix2d::Identity() - line.direction * line.direction.transpose()) / line.length;
  line.moving = weighted_gradient(line.weights, x);
  return line;
}

StringPlacementProgram::Slant StringPlacementProgram::slant(ConstVec z, ConstVec x, int pose, int string) const
{
  const Line at = line(z, x, pose, string);
  const InterpolatedNormal normal = normals_.interpolated(at.weights, x);
  Slant slant{1 - at.direction.dot(normal.value), {}};
  const int row = pose * string_count() + string, states = pose * state_size();
  const auto add = [&](int column, const Point<2>& slope) {
    for (int p = 0; p < 2; ++p) slant.row.emplace_back(row, column + p, mm * slope[p]);
  };
  const Point<2> turned = at.turning * normal.value;
  for (const BoundaryWeight& w : at.weights) add(states + 2 * w.vertex, w.value * turned);
  for (const auto& [vertex, slope] : normal.by_positions) add(states + 2 * vertex, -slope.transpose() * at.direction);
  slant.row.emplace_back(row, static_cast<int>(arc_start()) + string, -mm * turned.dot(at.along_ring));
  add(static_cast<int>(place_start()) + 2 * string,
      at.moving.transpose() * turned - normal.by_place.transpose() * at.direction);
  return slant;
}

template <class Visit>
void StringPlacementProgram::for_each_slant(ConstVec z, const Visit& visit) const
{
  for (int i = 0; i < pose_count(); ++i) {
    const Vec x = positions(z, i);
    for (int j = 0; j < string_count(); ++j) visit(slant(z, x, i, j));
  }
}

double StringPlacementProgram::objective(ConstVec z) const
{
  double sum = sliding_.value(places(z));
  for (int i = 0; i < pose_count(); ++i) {
    sum += (positions(z, i) - posed_.targets[static_cast<std::size_t>(i)]).squaredNorm() / (2 * mm * mm);
    sum += weights_.tension / 2 * z.segment(tension_start(i), string_count()).squaredNorm();
  }
  for_each_slant(z, [&](const Slant& slant) { sum += weights_.direction * slant.value * slant.value; });
  return sum;
}

void StringPlacementProgram::objective_gradient(ConstVec z, Vec& g) const
{
  g = Vec::Zero(variable_count());
  for (int i = 0; i < pose_count(); ++i) {
    g.segment(Eigen::Index(i) * state_size(), state_size()) =
        (positions(z, i) - posed_.targets[static_cast<std::size_t>(i)]) / mm;
    g.segment(tension_start(i), string_count()) = weights_.tension * z.segment(tension_start(i), string_count());
  }
  Vec by_place;
  sliding_.gradient(places(z), by_place);
  g.tail(by_place.size()) = by_place;
  for_each_slant(z, [&](const Slant& slant) {
    for (const auto& entry : slant.row) g[entry.col()] += 2 * weights_.direction * slant.value * entry.value();
  });
}

void StringPlacementProgram::gauss_newton_hessian(ConstVec z, SparseMatrix& H) const
{
  std::vector<Eigen::Triplet<double>> entries, rows;
  for (int i = 0; i < constraint_count(); ++i) entries.emplace_back(i, i, 1);
  for (auto k = static_cast<int>(tension_start(0)); k < arc_start(); ++k) entries.emplace_back(k, k, weights_.tension);
  sliding_.append_hessian(places(z), static_cast<int>(place_start()), entries);
  for_each_slant(z, [&](const Slant& slant) { rows.insert(rows.end(), slant.row.begin(), slant.row.end()); });
  SparseMatrix own(variable_count(), variable_count()),
      slants(Eigen::Index(pose_count()) * string_count(), variable_count());
  own.setFromTriplets(entries.begin(), entries.end());
  slants.setFromTriplets(rows.begin(), rows.end());
  H = own + SparseMatrix(2 * weights_.direction * (slants.transpose() * slants));
}

void StringPlacementProgram::constraints(ConstVec z, Vec& c) const
{
  c.resize(constraint_count());
  Vec g;
  for (int i = 0; i < pose_count(); ++i) {
    const Vec x = positions(z, i);
    posed_.body.gradient(x, posed_.densities, g);
    for (int j = 0; j < string_count(); ++j) {
      const Line at = line(z, x, i, j);
      for (const BoundaryWeight& w : at.weights) g.segment<2>(2 * w.vertex) -= at.tension * w.value * at.direction;
    }
    for (int k = 0; k < state_size(); ++k)
      if (is_held(k)) g[k] = (x[k] - start_positions_[static_cast<std::size_t>(i)][k]) / mm;
    c.segment(Eigen::Index(i) * state_size(), state_size()) = g;
  }
}

// The derivative of -tau w_m d for all vertices m of a string.
void StringPlacementProgram::append_string(const Line& line, int pose, int string,
                                           std::vector<Eigen::Triplet<double>>& entries) const
{
  const int states = pose * state_size(), arc = static_cast<int>(arc_start()) + string,
            place = static_cast<int>(place_start()) + 2 * string;
  const Eigen::Matrix2d stiffness = line.tension * line.turning;
  for (const BoundaryWeight& w : line.weights) {
    const int row = states + 2 * w.vertex;
    const Eigen::Matrix2d by_place =
        w.value * stiffness * line.moving - line.tension * line.direction * w.gradient.transpose();
    const Point<2> by_arc = -w.value * stiffness * line.along_ring;
    for (int p = 0; p < 2; ++p) {
      entries.emplace_back(row + p, tension_start(pose) + string, -w.value * line.direction[p]);
      entries.emplace_back(row + p, arc, mm * by_arc[p]);
      for (int q = 0; q < 2; ++q) {
        entries.emplace_back(row + p, place + q, mm * by_place(p, q));
        for (const BoundaryWeight& v : line.weights)
          entries.emplace_back(row + p, states + 2 * v.vertex + q, mm * w.value * v.value * stiffness(p, q));
      }
    }
  }
}

void StringPlacementProgram::constraint_jacobian(ConstVec z, SparseMatrix& J) const
{
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < pose_count(); ++i) {
    const Vec x = positions(z, i);
    const int at = i * state_size();
    posed_.body.hessian(x, posed_.densities, Projection::None, K_);
    for (int col = 0; col < K_.outerSize(); ++col)
      for (SparseMatrix::InnerIterator entry(K_, col); entry; ++entry)
        entries.emplace_back(at + static_cast<int>(entry.row()), at + col, mm * entry.value());
    for (int j = 0; j < string_count(); ++j) append_string(line(z, x, i, j), i, j, entries);
  }
  std::erase_if(entries, [this](const auto& entry) { return is_held(entry.row() % state_size()); });
  for (int row = 0; row < constraint_count(); ++row)
    if (is_held(row % state_size())) entries.emplace_back(row, row, 1);
  J.resize(constraint_count(), variable_count());
  J.setFromTriplets(entries.begin(), entries.end());
}

void StringPlacementProgram::step_metric(ConstVec, SparseMatrix& D) const
{
  std::vector<Eigen::Triplet<double>> entries;
  for (int k = constraint_count(); k < variable_count(); ++k) entries.emplace_back(k, k, 1);
  D.resize(variable_count(), variable_count());
  D.setFromTriplets(entries.begin(), entries.end());
}

std::optional<Vec> StringPlacementProgram::restore(ConstVec z) const
{
  if (!sliding_.are_within_reach(places(z))) return std::nullopt;
  NewtonOptions newton;
  newton.max_iterations = 25;
  const StringLayout strings = layout(z);
  Vec result = z;
  for (int i = 0; i < pose_count(); ++i) {
    const auto pose = static_cast<std::size_t>(i);
    const LoadedSolid<2> potential(posed_.body, posed_.densities, {}, {}, strings_of_pose(field_, strings, pose));
    // A predicted state may turn triangles over: then the last pose that was admissible is the one to start from.
    Vec x = positions(z, i);
    if (!std::isfinite(potential.value(x))) x = start_positions_[pose];
    for (int k = 0; k < state_size(); ++k)
      if (is_held(k)) x[k] = start_positions_[pose][k];
    const Equilibrium equilibrium = solve_equilibrium(potential, x, factorization_, newton, posed_.held);
    if (!equilibrium.report.converged()) {
      ++failed_equilibria_;
      return std::nullopt;
    }
    result.segment(Eigen::Index(i) * state_size(), state_size()) = equilibrium.x / mm;
  }
  return result;
}

}  // namespace softform
