#include "softform/inverse/material_design.hpp"

#include <algorithm>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <fmt/format.h>

#include "softform/core/error.hpp"

namespace softform {
namespace {

// rho_e - mean of the neighbours' rho (5.18), as a matrix.
template <int dim>
SparseMatrix smoothing_matrix(const Solid<dim>& body)
{
  std::vector<Eigen::Triplet<double>> entries;
  const auto neighbours = element_neighbours<dim>(body.elements());
  for (std::size_t e = 0; e < neighbours.size(); ++e) {
    const int row = static_cast<int>(e);
    if (neighbours[e].empty()) continue;
    entries.emplace_back(row, row, 1);
    for (const int k : neighbours[e]) entries.emplace_back(row, k, -1.0 / double(neighbours[e].size()));
  }
  SparseMatrix L(body.element_count(), body.element_count());
  L.setFromTriplets(entries.begin(), entries.end());
  return L;
}

template <int dim>
void require_pose(const Solid<dim>& body, const MaterialPose<dim>& pose, std::size_t number)
{
  const Eigen::Index size = body.rest_positions().size();
  require_target<dim>(body, pose.target, number);
  if (pose.start.size() != size || (pose.fixed.free.size() != 0 && pose.fixed.free.size() != size))
    throw InputError(fmt::format("pose {} has {} start coordinates, the body {}: poses need the body's own vertices",
                                 number, pose.start.size(), size));
}

}  // namespace

template <int dim>
void require_target(const Solid<dim>& body, const Vec& target, std::size_t pose)
{
  const Eigen::Index size = body.rest_positions().size();
  if (target.size() != size)
    throw InputError(fmt::format("pose {} has {} target coordinates, the body {}: poses need the body's own vertices",
                                 pose, target.size(), size));
  for (int e = 0; e < body.element_count(); ++e)
    if (!(body.deformation_gradient(target, e).determinant() > 0))
      throw InputError(fmt::format("pose {} turns element {} over: untangle the target", pose, e));
}

template <int dim>
MaterialDesign<dim>::MaterialDesign(const Solid<dim>& body, std::vector<MaterialPose<dim>> poses,
                                    EquilibriumLimits limits)
    : body_(body),
      poses_(std::move(poses)),
      limits_(limits),
      boundary_(boundary_vertices<dim>(body.elements())),
      smoothing_(smoothing_matrix<dim>(body)),
      smoothing_hessian_(smoothing_.transpose() * smoothing_),
      tangents_(poses_.size()),
      mixed_(poses_.size()),
      distance_weights_(poses_.size()),
      distance_forces_(poses_.size()),
      projections_(poses_.size())
{
  for (std::size_t i = 0; i < poses_.size(); ++i) require_pose<dim>(body, poses_[i], i);
  // With every diagonal entry, so that the weights can be added in place.
  SparseMatrix identity(body.element_count(), body.element_count());
  identity.setIdentity();
  smoothing_hessian_ = smoothing_hessian_ + 0.0 * identity;
}

template <int dim>
bool MaterialDesign<dim>::has_free_pins() const
{
  return std::any_of(poses_.begin(), poses_.end(), [](const auto& pose) { return pose.are_pins_free; });
}

// At the state's densities, with its pins.
template <int dim>
LoadedSolid<dim> MaterialDesign<dim>::potential(std::size_t pose, const State& state) const
{
  std::vector<Pin<dim>> pins = poses_[pose].pins;
  for (std::size_t j = 0; j < pins.size(); ++j)
    pins[j].position = state.pins[pose].template segment<dim>(dim * Eigen::Index(j));
  return LoadedSolid<dim>(body_, state.rho, poses_[pose].dead_loads, std::move(pins), poses_[pose].strings);
}

template <int dim>
std::optional<Vec> MaterialDesign<dim>::equilibrium(std::size_t pose, const State& state, const Vec& from,
                                                    const Vec& guess, const NewtonOptions& options) const
{
  const LoadedSolid<dim> problem = potential(pose, state);
  const bool is_guess_better = guess.size() > 0 && problem.value(guess) < problem.value(from);
  Equilibrium found =
      solve_equilibrium(problem, is_guess_better ? guess : from, newton_factorization_, options, poses_[pose].fixed);
  if (!found.report.converged()) return std::nullopt;
  return std::move(found.x);
}

// Of the boundary's vertices, in their order.
template <int dim>
Vec MaterialDesign<dim>::squared_distances(std::size_t pose, const Vec& x) const
{
  Vec squares(std::ssize(boundary_));
  for (Eigen::Index k = 0; k < squares.size(); ++k) {
    const Eigen::Index i = dim * Eigen::Index(boundary_[static_cast<std::size_t>(k)]);
    squares[k] = (x - poses_[pose].target).template segment<dim>(i).squaredNorm();
  }
  return squares;
}

template <int dim>
void MaterialDesign<dim>::measure(State& state) const
{
  state.distance = state.largest = 0;
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    const Vec squares = squared_distances(i, state.x[i]);
    state.distance += squares.mean() / double(poses_.size());
    state.largest = std::max(state.largest, squares.maxCoeff());
  }
}

// Of the squared coordinate differences in f, (dim n) [1/m^2].
template <int dim>
Vec MaterialDesign<dim>::distance_weights(std::size_t pose, const State& state, const MaterialWeights& weights) const
{
  const Vec squares = squared_distances(pose, state.x[pose]);
  Vec result = Vec::Zero(state.x[pose].size());
  for (Eigen::Index k = 0; k < squares.size(); ++k) {
    const double weight =
        1.0 / double(squares.size() * std::ssize(poses_)) + (squares[k] == state.largest ? weights.largest : 0.0);
    result.template segment<dim>(dim * Eigen::Index(boundary_[static_cast<std::size_t>(k)]))
        .setConstant(weight / (weights.length * weights.length));
  }
  return result;
}

template <int dim>
std::optional<typename MaterialDesign<dim>::State> MaterialDesign<dim>::start(const Vec& rho) const
{
  State starts;
  for (const MaterialPose<dim>& pose : poses_) {
    starts.x.push_back(pose.start);
    Vec& pins = starts.pins.emplace_back(dim * std::ssize(pose.pins));
    for (std::size_t j = 0; j < pose.pins.size(); ++j)
      pins.template segment<dim>(dim * Eigen::Index(j)) = pose.pins[j].position;
  }
  return restart(starts, rho);
}

template <int dim>
std::optional<typename MaterialDesign<dim>::State> MaterialDesign<dim>::restart(const State& from, const Vec& rho) const
{
  State state{rho, {}, from.pins, 0, 0};
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    auto x = equilibrium(i, state, from.x[i], {}, {});
    if (!x) return std::nullopt;
    state.x.push_back(std::move(*x));
  }
  measure(state);
  return state;
}

template <int dim>
std::optional<typename MaterialDesign<dim>::State> MaterialDesign<dim>::move(const State& from, const Vec& rho,
                                                                             const Step& step) const
{
  NewtonOptions options;
  options.max_iterations = limits_.max_iterations;
  State state{rho, {}, from.pins, 0, 0};
  for (std::size_t i = 0; i < step.pins.size(); ++i) state.pins[i] += step.pins[i];
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    auto x = equilibrium(i, state, from.x[i], step.x.empty() ? Vec() : Vec(from.x[i] + step.x[i]), options);
    if (!x || largest_nodal_norm(*x - from.x[i], dim) > limits_.largest_displacement) {
      ++refused_moves_;
      return std::nullopt;
    }
    state.x.push_back(std::move(*x));
  }
  measure(state);
  return state;
}

template <int dim>
double MaterialDesign<dim>::objective(const State& state, const MaterialWeights& weights) const
{
  const Vec& rho = state.rho;
  return (state.distance + weights.largest * state.largest) / (weights.length * weights.length) +
         (weights.crisp * rho.dot((1 - rho.array()).matrix()) + weights.smooth * (smoothing_ * rho).squaredNorm() +
          weights.soft * rho.squaredNorm()) /
             double(rho.size());
}

template <int dim>
const SparseMatrix& MaterialDesign<dim>::regulariser_hessian(const MaterialWeights& weights) const
{
  const double per_element = 2.0 / body_.element_count();
  regulariser_ = weights.smooth * per_element * smoothing_hessian_;
  shift_diagonal(regulariser_, weights.soft * per_element);
  return regulariser_;
}

template <int dim>
bool MaterialDesign<dim>::linearize(const State& state, const MaterialWeights& weights)
{
  const Vec& rho = state.rho;
  regulariser_gradient_ =
      regulariser_hessian(weights) * rho + weights.crisp / double(rho.size()) * (1 - 2 * rho.array()).matrix();
  SparseMatrix K;
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    const FixedDofs& fixed = poses_[i].fixed;
    potential(i, state).hessian(state.x[i], K);
    fixed.project(K, K.diagonal().cwiseAbs().mean());
    if (!tangents_[i].cholesky(K)) return false;
    body_.mixed_hessian(state.x[i], rho, mixed_[i]);
    if (fixed.free.size() > 0) mixed_[i] = fixed.free.asDiagonal() * mixed_[i];
    distance_weights_[i] = distance_weights(i, state, weights);
    distance_forces_[i] = 2 * distance_weights_[i].cwiseProduct(state.x[i] - poses_[i].target);
    if (!distance_forces_[i].allFinite()) return false;
    if (poses_[i].are_pins_free) linearize_pins(i);
  }
  damp_pins(0);
  return true;
}

template <int dim>
void MaterialDesign<dim>::linearize_pins(std::size_t pose)
{
  const auto& [target, start, fixed, dead_loads, pins, strings, are_pins_free] = poses_[pose];
  PinProjection& projection = projections_[pose];
  projection.sensitivity.resize(target.size(), dim * std::ssize(pins));
  for (Eigen::Index column = 0; column < projection.sensitivity.cols(); ++column) {
    const Pin<dim>& pin = pins[static_cast<std::size_t>(column / dim)];
    Vec pull = Vec::Zero(target.size());
    for (std::size_t k = 0; k < pin.point.vertices.size(); ++k)
      pull[dim * Eigen::Index(pin.point.vertices[k]) + column % dim] = pin.stiffness * pin.point.weights[k];
    fixed.project(pull);
    projection.sensitivity.col(column) = tangents_[pose].solve(pull);
  }
  const Eigen::MatrixXd& Y = projection.sensitivity;
  projection.hessian = 2 * Y.transpose() * distance_weights_[pose].asDiagonal() * Y;
  projection.gradient = Y.transpose() * distance_forces_[pose];
}

template <int dim>
void MaterialDesign<dim>::damp_pins(double damping)
{
  constexpr double round_off = 1e-10;
  for (PinProjection& projection : projections_) {
    if (projection.hessian.size() == 0) continue;
    Eigen::MatrixXd damped = projection.hessian;
    damped.diagonal().array() += (damping + round_off) * projection.hessian.diagonal().mean();
    projection.inverse = damped.ldlt().solve(Eigen::MatrixXd::Identity(damped.rows(), damped.cols()));
  }
}

// A force 2 W u with what the pins take of the displacements u left out: 2 W (u - Y dy) for the best dy.
template <int dim>
Vec MaterialDesign<dim>::past_pins(std::size_t pose, Vec force) const
{
  const auto& [Y, hessian, gradient, inverse] = projections_[pose];
  if (Y.size() > 0) force -= 2 * distance_weights_[pose].cwiseProduct(Y * (inverse * (Y.transpose() * force)).eval());
  return force;
}

template <int dim>
void MaterialDesign<dim>::gradient(Vec& g) const
{
  g = regulariser_gradient_;
  for (std::size_t i = 0; i < poses_.size(); ++i)
    g -= mixed_[i].transpose() * tangents_[i].solve(past_pins(i, distance_forces_[i]));
}

template <int dim>
double MaterialDesign<dim>::pin_decrease() const
{
  double sum = 0;
  for (const auto& [sensitivity, hessian, gradient, inverse] : projections_)
    if (gradient.size() > 0) sum += 0.5 * gradient.dot(inverse * gradient);
  return sum;
}

template <int dim>
void MaterialDesign<dim>::distance_product(ConstVec v, Vec& Hv) const
{
  Hv.setZero(v.size());
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    const Vec dx = tangents_[i].solve(mixed_[i] * v);
    const Vec adjoint = tangents_[i].solve(past_pins(i, 2 * distance_weights_[i].cwiseProduct(dx)));
    Hv += mixed_[i].transpose() * adjoint;
  }
}

template <int dim>
typename MaterialDesign<dim>::Step MaterialDesign<dim>::predict(ConstVec drho) const
{
  Step step;
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    Vec& dx = step.x.emplace_back(-tangents_[i].solve(mixed_[i] * drho));
    const auto& [Y, hessian, gradient, inverse] = projections_[i];
    Vec& dy = step.pins.emplace_back(Vec::Zero(dim * std::ssize(poses_[i].pins)));
    if (Y.size() == 0) continue;
    dy = -(inverse * (Y.transpose() * (distance_forces_[i] + 2 * distance_weights_[i].cwiseProduct(dx))));
    dx += Y * dy;
  }
  return step;
}

template <int dim>
int MaterialDesign<dim>::linear_solves() const
{
  int sum = newton_factorization_.attempts();
  for (const SparseFactorization& tangent : tangents_) sum += tangent.attempts();
  return sum;
}

template void require_target<2>(const Solid<2>&, const Vec&, std::size_t);
template void require_target<3>(const Solid<3>&, const Vec&, std::size_t);
template class MaterialDesign<2>;
template class MaterialDesign<3>;

}  // namespace softform
